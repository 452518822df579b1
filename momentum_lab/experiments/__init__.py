"""The chapter as experiments: its figures as runs whose claims can fail, its equations measured."""

"""Runs the blocks of docs/python.md in one namespace, in a folder that receives what they write: page.py PAGE FOLDER"""
import os
import re
import sys

page = open(sys.argv[1]).read()
os.makedirs(sys.argv[2], exist_ok=True)
os.chdir(sys.argv[2])
namespace: dict[str, object] = {}
for block in re.finditer(r"^```python\n(.*?)^```$", page, re.S | re.M):
    line = page[: block.start(1)].count("\n")
    code = compile("\n" * line + block[1], sys.argv[1], "exec")  # errors name the line of the page
    exec(code, namespace)

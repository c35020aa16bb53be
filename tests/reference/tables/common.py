"""Helpers of the table generators: wcsv and wjson write a table to tests/reference, check raises on a wrong value."""
import csv
import json
import os

import numpy as np

OUT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def wcsv(name, header, rows):
    with open(os.path.join(OUT, name), "w", newline="") as f:
        w = csv.writer(f); w.writerow(header)
        for r in rows: w.writerow([("%.12g" % x if isinstance(x, (float, np.floating)) else x) for x in r])
    print("wrote", name, len(rows))
def wjson(name, obj):
    with open(os.path.join(OUT, name), "w") as f: json.dump(obj, f, indent=1)
    print("wrote", name)
def check(what, a, b, tol):
    e = abs(a-b); print("  check %-55s %.10g vs %.10g  err %.1e" % (what, a, b, e)); assert e <= tol, what

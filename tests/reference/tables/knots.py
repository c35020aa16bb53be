"""Invariants of the prime knots of three to ten crossings, from KnotInfo (pip install database_knotinfo==2026.11.2)."""
import json

from tables.common import check, wcsv


def first(text):
    """The first braid word of KnotInfo's entry, which may be a list of words."""
    word = json.loads(text.replace("{", "[").replace("}", "]"))
    return word[0] if isinstance(word[0], list) else word


def tables():
    from database_knotinfo import link_list
    rows = []
    for knot in link_list()[1:]:  # the first entry holds the titles of the columns
        if not knot["crossing_number"].isdigit() or not 3 <= int(knot["crossing_number"]) <= 10:
            continue
        lowest, highest, *jones = json.loads(knot["jones_polynomial_vector"])
        alexander = json.loads(knot["alexander_polynomial_vector"])[2:]
        alexander = [c if alexander[0] > 0 else -c for c in alexander]
        check(f"{knot['name']}: terms of the Jones polynomial", len(jones), highest - lowest + 1, 0)
        check(f"{knot['name']}: Jones polynomial at 1", sum(jones), 1, 0)
        check(f"{knot['name']}: determinant", abs(sum((-1)**k*c for k, c in enumerate(alexander))), int(knot["determinant"]), 0)
        rows.append([knot["name"], "amphichiral" if "amphicheiral" in knot["symmetry_type"] else "chiral",
                     *(" ".join(map(str, v)) for v in (first(knot["braid_notation"]), alexander)), lowest, " ".join(map(str, jones))])
    check("prime knots to ten crossings", len(rows), 249, 0)
    wcsv("10_knot_invariants.csv", ["type", "symmetry", "braid", "alexander", "jones_lowest_exponent", "jones"], rows)

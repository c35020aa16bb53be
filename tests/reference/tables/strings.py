"""Catenaries and hanging strings."""
import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

from tables.common import check, wcsv


def tables():
    rows = []
    for d in (0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.999):   # span / length
        # u = span / (2 a), a the catenary's parameter (horizontal tension / weight per length).
        u = brentq(lambda u: np.sinh(u)/u-1/d, 1e-9, 50, xtol=1e-15)
        a = d/(2*u); rows.append([d, a, a*(np.cosh(u)-1), a, a*np.cosh(u), np.sinh(u), np.degrees(np.arctan(np.sinh(u)))])
        assert abs(2*a*np.sinh(u)-1) < 1e-11
    wcsv("02_catenary_inextensible.csv", ["span_over_S", "a_over_S", "sag_over_S", "H_over_wS", "Tend_over_wS", "slope_at_end", "angle_at_end_deg"], rows)
    S = []
    for d in (0.5, 0.8, 0.95):
        u = brentq(lambda u: np.sinh(u)/u-1/d, 1e-9, 50, xtol=1e-15); a = d/(2*u)
        for s in np.linspace(-0.5, 0.5, 101): S.append([d, s+0.5, a*np.arcsinh(s/a), np.hypot(a, s)-np.hypot(a, .5), np.hypot(a, s)])
    wcsv("02_catenary_shapes.csv", ["span_over_S", "s_over_S", "x_over_S_from_middle", "y_over_S_from_supports", "T_over_wS"], S)
    # Hanging elastic string, linear in nominal strain: lam = w L / EA (w weight per unstretched length), tip mass ratio
    # m = M g / (w L).
    rows = []
    for lam in (1e-4, 1e-3, 1e-2, 0.1, 0.5):
        for m in (0., 1., 10.):
            for s in (0.25, 0.5, 0.75, 1.0): rows.append([lam, m, s, s+lam*(s*(1+m)-s*s/2), 1-s+m])
    wcsv("02_hanging_elastic_string.csv", ["wL_over_EA", "tip_weight_over_wL", "s_over_L", "position_over_L", "T_over_wL"], rows)
    # Elastic catenary between level supports (Irvine 1981): unstretched length S, weight w per unstretched length,
    # stiffness EA.
    rows = []
    for d in (0.5, 0.8, 0.95, 1.0, 1.02):
        for lam in (1e-3, 1e-2, 0.1):
            f = lambda H: H*lam+2*H*np.arcsinh(0.5/H)-d                       # lengths / S, forces / (w S)
            H = brentq(f, 1e-6, 1e3, xtol=1e-15); T = np.hypot(H, .5)
            sag = lam*0.125+(np.hypot(H, .5)-H)
            rows.append([d, lam, H, T, sag])
    wcsv("02_elastic_catenary.csv", ["span_over_S0", "wS0_over_EA", "H_over_wS0", "Tend_over_wS0", "sag_over_S0"], rows)
    d, lam, H, T, sag = rows[0]
    z = quad(lambda s: s/np.hypot(H, s)+lam*s, 0, .5)[0]; check("elastic catenary sag by quadrature", z, sag, 1e-12)
    x = quad(lambda s: H/np.hypot(H, s)+lam*H, -.5, .5)[0]; check("elastic catenary span by quadrature", x, d, 1e-12)

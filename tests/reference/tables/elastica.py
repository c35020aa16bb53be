"""Elastica under a tip load and under its own weight."""
import mpmath as mp
import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from tables.common import check, wcsv

mp.mp.dps = 30


def elastica_tip(alpha):
    """Tip of a clamped rod under a dead load P normal to its undeformed axis; alpha = P L^2 / EI. Returns the tip angle
    phi, x/L and y/L (y: deflection)."""
    alpha = mp.mpf(alpha)
    def res(phi):
        k2 = (1+mp.sin(phi))/2; k = mp.sqrt(k2); t1 = mp.asin(1/(k*mp.sqrt(2)))
        return mp.ellipk(k2)-mp.ellipf(t1, k2)-mp.sqrt(alpha)
    # bisection, because res is monotone in phi
    lo, hi = mp.mpf('1e-12'), mp.pi/2-mp.mpf('1e-20')
    for _ in range(95):
        m = (lo+hi)/2
        if res(m) < 0: lo = m
        else: hi = m
    phi = (lo+hi)/2; k2 = (1+mp.sin(phi))/2; t1 = mp.asin(1/mp.sqrt(2*k2))
    y = 1-2/mp.sqrt(alpha)*(mp.ellipe(k2)-mp.ellipe(t1, k2)); x = mp.sqrt(2*mp.sin(phi)/alpha)
    return float(phi), float(x), float(y)
def elastica_shape(alpha, n=101):
    phi, x, y = elastica_tip(alpha)
    f = lambda s, u: [u[1], -alpha*np.cos(u[0]), np.cos(u[0]), np.sin(u[0])]
    s = np.linspace(0, 1, n)
    r = solve_ivp(f, (0, 1), [0, np.sqrt(2*alpha*np.sin(phi)), 0, 0], t_eval=s, method="DOP853", rtol=1e-12, atol=1e-13)
    check("elastica ODE vs elliptic, alpha=%g, tip y" % alpha, r.y[3, -1], y, 1e-9); check("  tip x", r.y[2, -1], x, 1e-9)
    return s, r.y
def heavy(G):
    """theta'' + G (1-s) cos(theta) = 0, theta(0)=0, theta'(1)=0; G = w L^3/EI; clamped horizontally.
    Shooting on the tip angle backwards from the free end (well conditioned, single root with 0<theta<pi/2)."""
    f = lambda s, u: [u[1], -G*(1-s)*np.cos(u[0]), np.cos(u[0]), np.sin(u[0])]
    back = lambda phi: solve_ivp(lambda s, u: [u[1], -G*(1-s)*np.cos(u[0])], (1, 0), [phi, 0], method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    hi = np.pi/2-1e-9
    phi = brentq(lambda p: back(p)[0], 1e-9, hi, xtol=1e-15)
    return f, back(phi)[1]
def tables():
    al = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.75, 0.8, 1, 1.25, 1.5, 1.75, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 9, 10]
    rows = []
    for a in al:
        p, x, y = elastica_tip(a); rows.append([a, x, y, 1-x, p, np.sqrt(2*a*np.sin(p)), y/(a/3)])
    wcsv("01_elastica_tip_load.csv", ["PL2_over_EI", "tip_x_over_L", "tip_y_over_L", "one_minus_x_over_L", "tip_angle_rad", "root_curvature_times_L", "y_over_linear_theory"], rows)
    # Mattiasson (1981), IJNME 17:145-153, printed values
    p, x, y = elastica_tip(1); check("Mattiasson a=1 w", y, 0.30172, 6e-6); check("Mattiasson a=1 u", 1-x, 0.05643, 6e-6); check("Mattiasson theta", p, 0.46135, 6e-6)
    p, x, y = elastica_tip(10); check("Mattiasson a=10 w", y, 0.81061, 6e-6); check("Mattiasson a=10 u", 1-x, 0.55500, 6e-6); check("theta", p, 1.43029, 6e-6)
    S = []
    for a in (1., 4., 10.):
        s, u = elastica_shape(a); S += [[a, s[i], u[2, i], u[3, i], u[0, i], u[1, i]] for i in range(len(s))]
    wcsv("01_elastica_tip_load_shapes.csv", ["PL2_over_EI", "s_over_L", "x_over_L", "y_over_L", "theta_rad", "kappa_times_L"], S)
    rows, S = [], []
    for G in (0.1, 0.5, 1, 2, 3, 5, 7.5, 10, 15, 20, 30, 50, 100):
        f, k0 = heavy(G); s = np.linspace(0, 1, 101)
        r = solve_ivp(f, (0, 1), [0, k0, 0, 0], t_eval=s, method="DOP853", rtol=1e-12, atol=1e-13)
        rows.append([G, r.y[2, -1], r.y[3, -1], r.y[0, -1], k0, r.y[3, -1]/(G/8)])
        if G == 0.1: check("heavy elastica small load", r.y[3, -1]/(G/8), 1, 2e-4)
        # global moment balance at the clamp: kappa(0) EI = w * integral x ds
        xs = solve_ivp(lambda s, u: list(f(s, u[:4]))+[u[2]], (0, 1), [0, k0, 0, 0, 0], method="DOP853", rtol=1e-12, atol=1e-13).y[4, -1]
        assert abs(k0-G*xs) < 1e-8*max(1, k0), (G, k0, G*xs)
        if G in (2, 10, 50): S += [[G, s[i], r.y[2, i], r.y[3, i], r.y[0, i], r.y[1, i]] for i in range(101)]
    wcsv("01_heavy_elastica.csv", ["wL3_over_EI", "tip_x_over_L", "tip_y_over_L", "tip_angle_rad", "root_curvature_times_L", "y_over_linear_theory"], rows)
    wcsv("01_heavy_elastica_shapes.csv", ["wL3_over_EI", "s_over_L", "x_over_L", "y_over_L", "theta_rad", "kappa_times_L"], S)

"""Contact: crossing threads, rods on a plane, a thread around a peg."""
import numpy as np
from scipy.integrate import solve_bvp
from scipy.optimize import brentq

from tables.common import wcsv


def tables():
    rows = []
    # Two crossing threads: A along x with ends (+-a, 0, 0), B along y with ends (0, +-b, H). A passes over B, zA = zB +
    # d; frictionless point contact.
    for a, b, H, d in ((0.05, 0.05, 0.01, 3e-4), (0.05, 0.05, 0.002, 3e-4), (0.05, 0.03, 0.01, 3e-4), (0.1, 0.05, 0.02, 1e-3)):
        for TA, TB in ((1., 1.), (1., 2.), (0.5, 5.)):
            def F(z): return 2*TA*z/np.hypot(z, a)-2*TB*(H-(z-d))/np.hypot(H-(z-d), b)
            z = brentq(F, -0.5, 0.5, xtol=1e-16); N = 2*TA*z/np.hypot(z, a); rows.append(["constant_tension", a, b, H, d, TA, TB, 0.0, z, z-d, N, TA, TB])
        for EA, T0 in ((100., 0.5), (1000., 0.5), (100., 0.0)):
            TT = lambda q, l: T0+EA*(np.hypot(q, l)/l-1)
            def F(z): q = H-(z-d); return 2*TT(z, a)*z/np.hypot(z, a)-2*TT(q, b)*q/np.hypot(q, b)
            z = brentq(F, 1e-9, H+d, xtol=1e-16); q = H-(z-d); rows.append(["elastic", a, b, H, d, T0, T0, EA, z, z-d, 2*TT(z, a)*z/np.hypot(z, a), TT(z, a), TT(q, b)])
    wcsv("06_crossing_threads.csv", ["kind", "a_m", "b_m", "H_m", "d_contact_m", "T0_A_N", "T0_B_N", "EA_N", "zA_m", "zB_m", "contact_force_N", "T_A_N", "T_B_N"], rows)
    # Winkler beam: a point force P on a long rod on an elastic foundation (a plane with contact stiffness k per
    # length).
    rows = []
    for EI, k, P in ((1e-6, 1e4, 1e-3), (1e-6, 1e5, 1e-2), (1e-5, 1e5, 1e-2), (1e-7, 1e6, 1e-2)):
        l = (k/(4*EI))**.25; rows.append([EI, k, P, 1/l, P*l/(2*k), P/(4*l), P*l/2])
    wcsv("06_rod_on_penalty_plane_point_load.csv", ["EI_Nm2", "k_N_per_m2", "P_N", "decay_length_1_over_lambda_m", "max_penetration_m", "max_moment_Nm", "max_line_pressure_N_m"], rows)
    # A heavy rod on a rigid plane, one end lifted to height H by a vertical force, without moment. Lb = (EI/w)^(1/3).
    rows = []
    for h in (0.001, 0.01, 0.05, 0.1, 0.2, 0.5, 1.0):   # H/Lb
        def rhs(x, y, p):  # x in 0..1, s = l x, y = (theta, kappa, X, Z); unknown: lifted length l and reaction R
            l, R = p; s = l*x; th, ka, X, Z = y
            return l*np.vstack([ka, (R-s)*np.cos(th), np.cos(th), np.sin(th)])
        # Equilibrium: the ground's reaction R acts at the lift-off point and the weight of the lifted length s hangs on
        # the rod, so theta'' = M' = (R - s) cos(theta); units: length Lb, force w Lb, moment w Lb^2.
        bc = lambda ya, yb, p: np.array([ya[0], ya[1], ya[2], ya[3], yb[3]-h, yb[1]])
        l0 = (24*h)**.25; x = np.linspace(0, 1, 60); s = l0*x
        z = -s**4/24+l0*s**3/12; zp = -s**3/6+l0*s*s/4; zpp = -s*s/2+l0*s/2
        sol = solve_bvp(rhs, bc, x, np.vstack([np.arctan(zp), zpp, s, z]), p=[l0, l0/2], tol=1e-9, max_nodes=20000)
        assert sol.success, h
        l, R = sol.p
        rows.append([h, l, (24*h)**.25, l-R, R, (24*h)**.25/2])
    wcsv("06_heavy_rod_lifted_from_plane.csv", ["H_over_Lb", "lifted_arclength_over_Lb", "linear_theory_length", "lift_force_over_wLb", "line_reaction_at_liftoff_over_wLb", "linear_theory_lift_force"], rows)
    rows = [[d, 2*np.sin(np.radians(d)/2), 1.0] for d in (5, 10, 30, 60, 90, 120, 180)]
    wcsv("06_taut_thread_around_peg.csv", ["deflection_deg", "total_peg_force_over_T(frictionless)", "line_pressure_times_r_over_T"], rows)

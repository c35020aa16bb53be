"""Friction: capstan, incline, stopping."""
import numpy as np

from tables.common import wcsv


def tables():
    rows = [[mu, th, np.exp(mu*np.radians(th))] for mu in (0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.7, 1.0) for th in (30, 45, 60, 90, 120, 180, 270, 360, 540, 720, 1080)]
    wcsv("05_capstan.csv", ["mu", "wrap_angle_deg", "T1_over_T2"], rows)
    # Capstan as a polygon: N equal kinks of angle theta / N, each a point contact at the limit of Coulomb friction,
    # whose normal is the kink's bisector.
    rows = []
    for mu in (0.1, 0.2, 0.3, 0.5):
        for th in (90, 180, 360):
            for N in (2, 4, 8, 16, 32, 64):
                q = np.tan(np.radians(th)/N/2)   # (T1 - T2) cos(a) = mu (T1 + T2) sin(a), a: half the kink; q = tan(a)
                rows.append([mu, th, N, ((1+mu*q)/(1-mu*q))**N, ((1+mu*q)/(1-mu*q))**N/np.exp(mu*np.radians(th))-1])
    wcsv("05_capstan_polygonal.csv", ["mu", "wrap_angle_deg", "N_contact_nodes", "T1_over_T2", "relative_to_exponential"], rows)
    g = 9.81; rows = []
    for mu in (0.1, 0.2, 0.3, 0.5, 0.8):
        for a in (5, 10, 15, 20, 25, 30, 40, 50):
            r = np.radians(a); stick = np.tan(r) <= mu
            rows.append([mu, a, "stick" if stick else "slide", 0.0 if stick else g*(np.sin(r)-mu*np.cos(r)), np.degrees(np.arctan(mu))])
    wcsv("05_incline.csv", ["mu(static=kinetic)", "incline_deg", "state_from_rest", "acceleration_down_m_s2(g=9.81)", "threshold_deg"], rows)
    rows = []
    for mu in (0.1, 0.2, 0.3, 0.5):
        for v in (0.01, 0.05, 0.1, 0.5, 1.0): rows.append([mu, v, v*v/(2*mu*g), v/(mu*g)])
    wcsv("05_stopping_distance.csv", ["mu", "v0_m_s", "distance_m(g=9.81)", "time_s"], rows)
    # Block on a slowly pulled spring: the elongation at which it begins to slip, and the distance that it slips.
    rows = []
    for mu, k, m in ((0.3, 100., 0.001), (0.3, 1000., 0.001), (0.5, 100., 0.01)):
        rows.append([mu, k, m, mu*m*g/k, 2*mu*m*g/k])
    wcsv("05_stick_slip_spring.csv", ["mu", "k_N_m", "m_kg", "max_static_elongation_m", "half_band_release: block at rest iff |x-x0|<=this_m"], [r[:4]+[r[3]] for r in rows])

"""Largest stiffness of a virtual wall (spring K, damper B) on a device with damping b, sampled with period T: for
passivity, and for stability."""
import numpy as np
from scipy.optimize import brentq

from tables.common import check, wcsv


def tables():
    T = 1e-3; rows = []
    for b in (0.05, 0.1, 0.2, 0.5, 1., 2., 5., 10.):
        for B in (0., 0.1, 0.5, 1.0, 2.0, 5.0):
            if B < b: rows.append([T, b, B, 2*(b-B)/T])
    wcsv("09_virtual_wall_passivity.csv", ["T_s", "device_damping_b_Ns_m", "virtual_damping_B_Ns_m(backward_difference)", "max_passive_K_N_m"], rows)
    # Damping b that passivity needs, by the condition of Colgate and Schenkel at each frequency w: b > T/2 / (1 - cos
    # wT) Re{(1 - e^{-jwT}) H(e^{jwT})}, with H = (K + B (z-1) / (T z)) z^-d and d samples of delay.
    def need(K, B, d, n=20001):
        w = np.linspace(1e-4, np.pi, n)/T; z = np.exp(1j*w*T); H = (K+B*(z-1)/(T*z))*z**(-d)
        return (T/2/(1-np.cos(w*T))*((1-1/z)*H).real).max()
    check("K=1000,B=0 -> KT/2", need(1000., 0., 0), 0.5, 1e-6); check("K=1000,B=.3 -> KT/2+B", need(1000., .3, 0), .8, 1e-6); check("K=1000,B=-.1", need(1000., -.1, 0), .6, 1e-6)
    rows = []
    for d in (0, 1, 2):
        for b in (0.05, 0.1, 0.2, 0.5, 1., 2., 5., 10.):
            for B in (0., 0.1, 0.5, 1.0):
                if B >= b: continue
                if need(0., B, d) > b: rows.append([T, d, b, B, "not passive for any K>=0"]); continue
                K = brentq(lambda K: need(K, B, d)-b, 0, 1e6, xtol=1e-6); rows.append([T, d, b, B, K])
    wcsv("09_virtual_wall_passivity_delay.csv", ["T_s", "delay_samples", "b_Ns_m", "B_Ns_m", "max_passive_K_N_m"], rows)
    r = [q for q in rows if q[1] == 1 and q[3] == 0.0 and q[2] == 1.0][0]; check("one-sample delay, B=0: K = b/(T/2+T)", r[4], 1/(1.5*T), 1.0)
    # Stability without a hand: mass m and damper b with zero-order hold, solved exactly in discrete time.
    rows = []
    for m in (0.05, 0.1, 0.2):
        for b in (0.1, 0.5, 1., 2., 5.):
            for B in (0., 0.5):
                for d in (0, 1):
                    e = np.exp(-b*T/m)
                    A = np.array([[1, m/b*(1-e)], [0, e]]); Bd = np.array([T/b-m/b**2*(1-e), (1-e)/b])
                    def rad(K):
                        # States x_k, v_k, x_{k-1}, x_{k-2}; force -(K x + B (x - previous x) / T), delayed by d
                        # samples.
                        nS = 4; M = np.zeros((nS, nS)); M[:2, :2] = A; M[2, 0] = 1; M[3, 2] = 1
                        g = np.zeros(nS)
                        if d == 0: g[0] = K+B/T; g[2] = -B/T
                        else: g[2] = K+B/T; g[3] = -B/T
                        M[0] -= Bd[0]*g; M[1] -= Bd[1]*g
                        return np.abs(np.linalg.eigvals(M)).max()
                    Ks = np.geomspace(1, 1e7, 1500); st = [rad(K) <= 1+1e-12 for K in Ks]
                    if not st[0]: continue
                    i = st.index(False) if False in st else None
                    if i is None: continue
                    rows.append([T, m, b, B, d, brentq(lambda K: rad(K)-1-1e-12, Ks[i-1], Ks[i], xtol=1e-6)])
    wcsv("09_virtual_wall_uncoupled_stability.csv", ["T_s", "m_kg", "b_Ns_m", "B_Ns_m", "delay_samples", "max_stable_K_N_m"], rows)

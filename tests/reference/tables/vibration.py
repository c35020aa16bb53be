"""Bending modes and hanging chains."""
import numpy as np
from scipy.optimize import brentq
from scipy.special import jn_zeros

from tables.common import check, wcsv


def tables():
    f = lambda b: np.cosh(b)*np.cos(b)+1
    b = [brentq(f, lo, hi, xtol=1e-15) for lo, hi in ((1, 3), (4, 5.5), (7, 8.5), (10.5, 11.5), (14, 14.5))]
    g = lambda b: np.cosh(b)*np.cos(b)-1
    c = [brentq(g, lo, hi, xtol=1e-15) for lo, hi in ((4, 5.5), (7, 8.5), (10.5, 11.5))]
    check("cantilever beta1 L", b[0], 1.8751040687119611, 1e-12); check("clamped-clamped beta1 L", c[0], 4.730040744862704, 1e-12)
    rows = [["cantilever", i+1, b[i], b[i]**2] for i in range(5)]+[["clamped_clamped", i+1, c[i], c[i]**2] for i in range(3)]
    rows += [["pinned_pinned", i, i*np.pi, (i*np.pi)**2] for i in (1, 2, 3)]
    wcsv("03_bending_modes.csv", ["ends", "mode", "beta_L", "omega_times_L2_sqrt(rhoA_over_EI)"], rows)
    j = jn_zeros(0, 5); wcsv("03_hanging_chain_modes.csv", ["mode", "j0n", "omega_times_sqrt(L_over_g)"], [[i+1, j[i], j[i]/2] for i in range(5)])
    # Hanging chain of N equal masses on massless inextensible links of length l = L/N: omega^2 = (g/l) times the roots
    # of the Laguerre polynomial L_N.
    rows = []
    for N in (2, 3, 10, 20, 50, 100, 200):
        # The roots are the eigenvalues of the Jacobi matrix of the Laguerre polynomials.
        A = np.diag(2*np.arange(N)+1.)-np.diag(np.arange(1, N), 1)-np.diag(np.arange(1, N), -1)
        e = np.sort(np.linalg.eigvalsh(A))[:3]
        rows += [[N, i+1, np.sqrt(e[i]*N), np.sqrt(e[i]*N)/(j[i]/2)-1] for i in range(min(3, N))]
        # check against the eigenvalues of the linearised chain of 10 masses
        if N == 10:
            T = np.arange(N, 0, -1)*1.0  # tension above mass k (0: top) in units of m g; g = l = m = 1
            K = np.zeros((N, N))
            for k in range(N):
                K[k, k] += T[k]
                if k+1 < N: K[k, k] += T[k+1]; K[k, k+1] -= T[k+1]; K[k+1, k] -= T[k+1]
            check("Laguerre roots = linearised chain", np.sort(np.linalg.eigvalsh(K))[0], e[0], 1e-10)
    wcsv("03_hanging_chain_modes_discrete.csv", ["N_masses", "mode", "omega_times_sqrt(L_over_g)", "relative_to_continuum"], rows)
    ex = []
    for name, E, rho, d, L in (("steel_like_check", 200e9, 7850., 1e-3, 0.3), ("polymer_thread_check", 2e9, 1140., 0.3e-3, 0.05), ("soft_thread_check", 1e6, 1000., 1e-3, 0.1)):
        A = np.pi*d*d/4; I = np.pi*d**4/64; cL = np.sqrt(E/rho); G = E/(2*(1+0.4))
        ex.append([name, E, rho, d, L]+[b[i]**2*np.sqrt(E*I/(rho*A))/L**2/(2*np.pi) for i in range(3)]+[cL, cL/(4*L), cL/(2*L), np.sqrt(G/rho), j[0]/2*np.sqrt(9.81/L)/(2*np.pi)])
    wcsv("03_frequencies_dimensional_examples.csv", ["case", "E_Pa", "rho_kg_m3", "d_m", "L_m", "f1_Hz", "f2_Hz", "f3_Hz", "c_longitudinal_m_s", "f1_axial_fixed_free_Hz", "f1_axial_fixed_fixed_Hz", "c_torsional_m_s(nu=0.4)", "f1_hanging_chain_Hz(EI=0,g=9.81)"], ex)

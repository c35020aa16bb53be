"""Twisted rods: straight, ring, localised helix."""
import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

from tables.common import check, wcsv, wjson


def clamped_twist_det(m, t):
    """Determinant of the buckling problem of a twisted clamped rod; zero at buckling. B w'''' - i M w''' - T w'' = 0 on
    (0, 1) for the complex deflection w; m = M L / B, t = T L^2 / B."""
    disc = np.sqrt(complex(4*t-m*m)); l1 = (1j*m+disc)/2; l2 = (1j*m-disc)/2
    if abs(l1) < 1e-9 or abs(l2) < 1e-9 or abs(l1-l2) < 1e-9: return np.nan
    f = [lambda s: 1, lambda s: s, lambda s: np.exp(l1*s), lambda s: np.exp(l2*s)]
    g = [lambda s: 0, lambda s: 1, lambda s: l1*np.exp(l1*s), lambda s: l2*np.exp(l2*s)]
    A = np.array([[q(0) for q in f], [q(0) for q in g], [q(1) for q in f], [q(1) for q in g]], complex)
    D = np.linalg.det(A)*np.exp(-1j*m/2)      # real up to a constant phase
    return (D/(1j*disc)).real if abs((D/(1j*disc)).real) >= abs((D/(1j*disc)).imag) else (D/(1j*disc)).imag
def clamped_m(t):
    lo = np.sqrt(max(4*t, 0))+1e-3
    ms = np.linspace(lo, lo+14, 6000); v = [clamped_twist_det(m, t) for m in ms]
    for a, b, p, q in zip(ms[:-1], ms[1:], v[:-1], v[1:]):
        if p*q < 0 and abs(p) < 1e6:
            r = brentq(lambda m: clamped_twist_det(m, t), a, b, xtol=1e-12)
            if r > lo+2e-3: return r
def disc_twist_m(t, N=400):
    """Critical m = M L / B by another method than clamped_twist_det(): finite differences of the energy's second
    variation; the smallest m with a zero eigenvalue."""
    h = 1./N; n = N-1
    D2 = (np.diag(-2*np.ones(n))+np.diag(np.ones(n-1), 1)+np.diag(np.ones(n-1), -1))/h**2
    e0 = np.zeros(n); e0[0] = 1; e1 = np.zeros(n); e1[-1] = 1
    D1 = (np.diag(np.ones(n-1), 1)-np.diag(np.ones(n-1), -1))/(2*h)
    K4 = D2@D2+2*(np.outer(e0, e0)+np.outer(e1, e1))/h**4-0*D2
    K4[0, 0] = 7/h**4; K4[-1, -1] = 7/h**4
    # The term i M w''' of the twisting moment, as a Hermitian matrix.
    D3 = np.zeros((n, n))
    for i in range(n):
        for k, c in ((-2, -.5), (-1, 1.), (1, -1.), (2, .5)):
            j = i+k
            if 0 <= j < n: D3[i, j] += c/h**3
            elif j in (-2, n+1): # node beyond a clamped end: w(-h) = w(h)
                jj = 0 if j == -2 else n-1; D3[i, jj] += c/h**3
    S = 1j*D3; S = (S+S.conj().T)/2
    ev = np.linalg.eigvals(np.linalg.solve(K4-t*D2, S)).real   # K w = m S w
    return 1/np.max(np.abs(ev))
def gauss_writhe(r):
    """Writhe of a smooth closed curve, sampled uniformly in its parameter, by Gauss' double integral: derivatives by
    Fourier transform, the trapezoidal rule without the diagonal."""
    n = len(r); k = np.fft.fftfreq(n, 1./n)
    d = np.real(np.fft.ifft(1j*k[:, None]*np.fft.fft(r, axis=0), axis=0))
    D = r[:, None]-r[None]; c = np.cross(d[:, None], d[None]); R = np.linalg.norm(D, axis=2)+np.eye(n)
    return (np.einsum("ijk,ijk->ij", c, D)/R**3*(1-np.eye(n))).sum()*(2*np.pi/n)**2/(4*np.pi)
def michell_check(n=2, eps=0.02, N=400):
    ph = np.arange(N)*2*np.pi/N
    def curve(e, d): return np.c_[(1+d*np.sin(n*ph))*np.cos(ph), (1+d*np.sin(n*ph))*np.sin(ph), e*np.cos(n*ph)]
    def curve2(e, d): # tangential part u: keeps the length to first order
        u = d*np.cos(n*ph)/n; er = np.c_[np.cos(ph), np.sin(ph), 0*ph]; et = np.c_[-np.sin(ph), np.cos(ph), 0*ph]
        return er*(1+d*np.sin(n*ph))[:, None]+et*u[:, None]+np.c_[0*ph, 0*ph, e*np.cos(n*ph)]
    def Eb(r):
        k = np.fft.fftfreq(N, 1./N)[:, None]; F = np.fft.fft(r, axis=0)
        d1 = np.real(np.fft.ifft(1j*k*F, axis=0)); d2 = np.real(np.fft.ifft(-k*k*F, axis=0)); v = np.linalg.norm(d1, axis=1)
        kap = np.linalg.norm(np.cross(d1, d2), axis=1)/v**3
        # Bending energy times length, independent of scale (B = 1).
        return 0.5*(kap**2*v).mean()*2*np.pi*(v.mean()*2*np.pi)
    E0 = Eb(curve2(0, 0)); a = (Eb(curve2(eps, 0))-E0)/eps**2; b = (Eb(curve2(0, eps))-E0)/eps**2
    w = (gauss_writhe(curve2(eps, eps))-gauss_writhe(curve2(eps, -eps)))/(2*eps**2)
    # Energy times length of a ring with twist Tw0 turns and modes of amplitude e (out of plane) and d (in plane): E*L =
    # a e^2 + b d^2 + C/2 (2 pi)^2 (Tw0 - w e d)^2; unstable when C (2 pi)^2 Tw0 |w| = 2 sqrt(a b).
    return 2*np.sqrt(a*b)/((2*np.pi)**2*abs(w))                     # critical twist times C/B, in turns
def tables():
    rows = []
    for t in (-30., -20., -10., -5., -1., 0.001, 1., 2., 5., 10., 20., 50., 100., 200., 500.):
        m = clamped_m(t); mp_ = np.sqrt(4*np.pi**2+4*t) if t > -np.pi**2 else float('nan')
        rows.append([t if t != 0.001 else 0.0, m, mp_, m/(2*np.pi)])
    x = brentq(lambda y: np.tan(y)-y, 4.4, 4.6, xtol=1e-14)*2
    i0 = [r for r in rows if r[0] == 0.0][0]; check("clamped twist, T=0: tan(m/2)=m/2", i0[1], x, 2e-4); i0[1] = x; i0[2] = 2*np.pi; i0[3] = x/2/np.pi
    for t in (-20., 0., 50.):
        r = [q for q in rows if q[0] == t][0]; m1, m2 = disc_twist_m(t, 200), disc_twist_m(t, 400); check("finite differences (Richardson), t=%g" % t, m2+(m2-m1)/3, r[1], 2e-3*r[1])
    wcsv("04_twist_buckling_straight_rod.csv", ["TL2_over_B", "ML_over_B_clamped_clamped", "ML_over_B_greenhill_pinned", "critical_end_rotation_turns_times_C_over_B_clamped"], rows)
    rows = []
    for n in (2, 3, 4):
        m = [michell_check(n, e, 500) for e in (0.04, 0.02)]; v = m[1]+(m[1]-m[0])/3
        rows.append([n, np.sqrt(n*n-1.), v]); check("Michell ring mode %d: sqrt(n^2-1) vs direct energy/writhe" % n, v, np.sqrt(n*n-1.), 5e-3)
    R = []
    for BC in (1.0, 1.25, 1.3, 1.4, 1.5, 2.0, 0.5): R.append([BC, np.sqrt(3)*BC, 2*np.pi*np.sqrt(3)*BC])
    wcsv("04_michell_ring.csv", ["B_over_C(=EI/GJ=1+nu_for_circular)", "critical_twist_turns", "critical_twist_rad"], R)
    wcsv("04_michell_ring_modes.csv", ["mode_n", "critical_Tw_times_C_over_B_turns_formula", "direct_numerical_check"], rows)
    # Localised helical buckling (writhing), by the solution for an infinite rod: stiffnesses B (bending) and C (twist),
    # length L, total end rotation Phi, end shortening D.
    def loc(B, C, L, Phi, D):
        def F(q):
            m = q[0]; T = q[1]; return [2*m*np.sqrt(B*T)*L/C+4*np.arccos(m)-Phi, 4*np.sqrt(B/T)*np.sqrt(1-m*m)-D]
        best = None
        for m0 in np.linspace(0.05, 0.99, 40):
            T0 = B*16*(1-m0*m0)/D**2; g = 2*m0*np.sqrt(B*T0)*L/C+4*np.arccos(m0)-Phi
            if best is not None and best[1]*g < 0:
                m = brentq(lambda m: 2*m*np.sqrt(B*B*16*(1-m*m)/D**2)*L/C+4*np.arccos(m)-Phi, best[0], m0, xtol=1e-15)
                yield m, B*16*(1-m*m)/D**2
            best = (m0, g)
    out = []; env = []
    case = dict(B=1.345, C=0.789, L=100.0, rotation_turns=27, end_shortening=3.0)
    for m, T in loc(case["B"], case["C"], case["L"], 2*np.pi*case["rotation_turns"], case["end_shortening"]):
        B = case["B"]; M = 2*m*np.sqrt(B*T); u0 = 2*m*m-1; sg = np.sqrt(T/B)*np.sqrt(1-m*m)
        out.append(dict(m=m, T=T, M=M, phi0_rad=float(np.arccos(u0)), decay_rate_sigma=sg, decay_number_sigma_L_over_2=sg*case["L"]/2, M2_over_BT=M*M/(B*T), twist_turns=M*case["L"]/case["C"]/2/np.pi, link_turns=case["rotation_turns"], writhe_turns=2*np.arccos(m)/np.pi))
    # the branch reached by the benchmark: sliding end, twist stays high -> larger m
    for k, o in enumerate(out):
        for s in np.linspace(-50, 50, 201):
            f = np.tanh(o["decay_rate_sigma"]*s)**2; u = 2*o["m"]**2-1+(1-(2*o["m"]**2-1))*f
            env.append([k, s, f, np.arccos(min(1, u))])
    wjson("04_localised_helical_buckling.json", dict(case=case, note="infinite-rod homoclinic solution; each entry a solution branch of (rotation, shortening); envelope f=(cos phi-cos phi0)/(1-cos phi0)=tanh^2(sigma s)", branches=out))
    wcsv("04_localised_helical_buckling_envelope.csv", ["branch", "s_from_middle", "envelope_f", "phi_rad"], env)
    # The closed forms are checked by integrating the solution of the differential equation numerically.
    o = out[0]; u0 = 2*o["m"]**2-1; U = lambda s: u0+(1-u0)*np.tanh(o["decay_rate_sigma"]*s)**2
    check("end shortening by quadrature", quad(lambda s: 1-U(s), -400, 400, limit=2000, points=[0])[0], case["end_shortening"], 1e-6)
    rot = o["M"]*100/case["C"]+o["M"]/case["B"]*quad(lambda s: (1-U(s))/(1+U(s)), -400, 400, limit=2000, points=[0])[0]
    check("end rotation by quadrature", rot, 2*np.pi*27, 1e-5)
    # The solution U(s) must satisfy u'^2 = (1-u)^2 [(2T/B)(1+u) - (M/B)^2].
    s0, h = 2.0, 1e-4; du = (U(s0+h)-U(s0-h))/2/h; u = U(s0)
    check("first integral", du**2, (1-u)**2*(2*o["T"]/case["B"]*(1+u)-(o["M"]/case["B"])**2), 1e-7)
    # The same solution as a dimensionless curve.
    wcsv("04_localised_helical_buckling_curve.csv", ["M_over_2sqrt(BT)", "phi0_rad", "D_times_sqrt(T_over_B)", "writhe_rotation_rad"], [[m, np.arccos(2*m*m-1), 4*np.sqrt(1-m*m), 4*np.arccos(m)] for m in np.linspace(0, 1, 41)])

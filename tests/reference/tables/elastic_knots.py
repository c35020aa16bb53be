"""Loose elastic knots: the contact problem of the braid, after Audoly, Clauvelin and Neukirch (2007)."""
import numpy as np

from tables.common import check, wcsv


def braid(n, S=9.0, N=900, newton=60, rho0=20., verbose=False):
    """Braid of the loose open knot with 2n+1 crossings (Audoly, Clauvelin, Neukirch 2007). Unknown: the vector v(s)
    between the two strands, in units of the contact distance d; s in units of sqrt(d R), R the loop's radius. Minimises
    1/4 int |v''|^2 - 1/2 [v_x'(S) + v_x'(-S)] with |v| >= 1 and a total winding of (2n+1) pi, on the half domain [0, S]
    (v_x odd, v_y even), by finite differences, an augmented Lagrangian and damped Newton steps. Returns, among others,
    the minimum J and Q = int q ds, q the contact force: v'''' = q v/|v|."""
    import scipy.sparse as sp, scipy.sparse.linalg as sl
    h = S/N; sgn = -1 if n % 2 == 1 else 1
    # Nodes 0 .. N at s = i h. Second differences at nodes 0 .. N-1 (at 0 by symmetry); integrals by the trapezoidal
    # rule.
    def D2mat(par):
        D = sp.lil_matrix((N, N+1))
        for i in range(1, N): D[i, i-1] = 1; D[i, i] = -2; D[i, i+1] = 1
        if par == "even": D[0, 0] = -2; D[0, 1] = 2
        return (D/h**2).tocsr()
    w = np.ones(N); w[0] = .5; W = sp.diags(w*h)
    Dx, Dy = D2mat("odd"), D2mat("even")
    Kx, Ky = Dx.T@W@Dx, Dy.T@W@Dy      # bending energy of the half domain: 1/2 v . K v
    K = sp.block_diag([Kx, Ky]).tocsc()
    b = np.zeros(2*(N+1)); b[N] = 1/h; b[N-1] = -1/h; b *= 1.0     # end term -v_x'(S)
    # The end slope is that at S - h/2, so J below is computed with the length S_e = S - h/2.
    s = np.arange(N+1)*h
    ang = np.pi/2-0*s; wind = (2*n+1)*np.pi/2
    L0 = 1.6*n+0.8; th = wind*np.clip(s/L0, 0, 1); rho = np.where(s < L0, 1.02, np.sqrt(1.02+((s-L0)**2/2)**2))
    v = np.r_[rho*np.sin(th)*sgn, rho*np.cos(th)]; v[0] = 0
    lam = np.zeros(N+1); rho_p = rho0
    wt = np.ones(N+1)*h; wt[0] = h/2
    fixed = np.zeros(2*(N+1), bool); fixed[0] = True; free = np.where(~fixed)[0]
    def parts(v):
        x, y = v[:N+1], v[N+1:]; r = np.hypot(x, y); return x, y, r, 1-r
    def phi(v, lam, rp):
        x, y, r, g = parts(v); t = np.maximum(0, lam+rp*g); return .5*v@(K@v)-b@v+(wt*(t*t-lam*lam)/(2*rp)).sum()
    def solve_inner(v, lam, rp, tol):
        for it in range(newton):
            x, y, r, g = parts(v); t = np.maximum(0, lam+rp*g); act = t > 0; nx, ny = x/r, y/r
            G = K@v-b; G[:N+1] -= wt*t*nx; G[N+1:] -= wt*t*ny
            if np.abs(G[free]).max() < tol: break
            c = np.where(act, rp, 0)*wt; q = -wt*t/r     # q: contact force turns with the strand
            q = np.where(act, q, 0)
            mu = 0.0
            for tr in range(12):
                qq = q*(1 if tr == 0 else 0)
                H = K+sp.bmat([[sp.diags(c*nx*nx+qq*ny*ny), sp.diags((c-qq)*nx*ny)], [sp.diags((c-qq)*nx*ny), sp.diags(c*ny*ny+qq*nx*nx)]]).tocsc()+mu*sp.eye(2*(N+1))
                st = np.zeros_like(v); st[free] = sl.spsolve(H[free][:, free].tocsc(), -G[free])
                if st@G < 0: break
                mu = max(10*mu, 1e-6)
            # Steps of the nodes are limited, so that the strands cannot pass through each other.
            mx = np.abs(st).max(); a = min(1., 0.25/max(1e-12, np.abs(st[np.r_[r < 3, r < 3]]).max() if (r < 3).any() else mx)); f0 = phi(v, lam, rp)
            while phi(v+a*st, lam, rp) > f0+1e-4*a*(G@st) and a > 1e-8: a *= .5
            v = v+a*st
        return v, it
    for k in range(22):
        v, it = solve_inner(v, lam, rho_p, 1e-9)
        x, y, r, g = parts(v); lam = np.maximum(0, lam+rho_p*g); viol = max(0, g.max())
        if viol < 1e-8 and it < 3: break
        if k < 14: rho_p *= 1.6
    # The multiplier lam of the half-domain problem is the contact force per length, q = v''''.
    Q = 2*(wt*lam).sum()      # over the full line; a scaling identity says Q = J
    E = .5*v@(K@v)-b@v; S_e = S-h/2; J = E+S_e/2
    ang = np.unwrap(np.arctan2(y, x)); turns = abs(ang[-1]-ang[0])/np.pi*2
    con = lam > 1e-6*lam.max(); runs = []
    i = 0
    while i <= N:
        if con[i]:
            j = i
            while j < N and con[j+1]: j += 1
            runs.append((i*h, j*h, 2*(wt*lam)[i:j+1].sum()*2 if i == 0 else 2*(wt*lam)[i:j+1].sum())); i = j
        i += 1
    return dict(n=n, N=N, S=S, Q=Q, J=J, violation=float(viol), winding_pi=float(turns), slope_y=float((y[-1]-y[-2])/h), contact_runs=runs[:8], v=v, lam=lam, h=h)
def tables():
    res = []
    for n in (1, 2):
        S = 5.0+1.5*n; N = int(60*S); a = braid(n, S, N//2); b_ = braid(n, S, N); S2 = braid(n, S+1.5, int(60*(S+1.5)))
        dJ = abs(b_["J"]-a["J"])+abs(S2["J"]-b_["J"])+abs(b_["violation"])*b_["J"]
        print("  n=%d Q %.6f J %.6f +- %.1e (coarse %.6f, larger S %.6f) winding/pi %.3f contact runs %s" % (n, b_["Q"], b_["J"], dJ, a["J"], S2["J"], b_["winding_pi"], [(round(p, 3), round(q, 3), round(float(f), 4)) for p, q, f in b_["contact_runs"]]), flush=True)
        check("scaling identity Q=J", b_["Q"], b_["J"], 0.012*b_["J"])
        res.append((n, b_["J"], dJ))
    check("sigma(n=1) vs 0.492 (Audoly et al. 2007, quoted from memory)", res[0][1]/(2*np.sqrt(2)), 0.492, 1e-3)
    wcsv("07_elastic_knot_constants.csv", ["n(unknotting_number;1=trefoil,2=cinquefoil)", "J", "J_error_estimate", "sigma_radius_based=J/(2sqrt2)", "sigma_diameter_based=J/2", "energy_slope_c=3J/(2pi)"], [[n, J, e, J/(2*np.sqrt(2)), J/2, 3*J/(2*np.pi)] for n, J, e in res])
    rows = []
    for n, J, e in res:
        for aR in (1e-4, 3e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2):
            for mu in (0., 0.05, 0.1, 0.2):
                T0 = .5*aR**2; f = mu*J/(2*np.sqrt(2))*aR**1.5; c = 1+3*J/(2*np.pi)*np.sqrt(2*aR)
                rows.append([n, aR, mu, T0, T0+f, max(0., T0-f), T0*c, mu*J/(2*np.sqrt(2))/(.5*np.sqrt(aR)), int(mu*J/(2*np.sqrt(2))/(.5*np.sqrt(aR)) >= 1)])
    wcsv("07_elastic_knot_tension.csv", ["n", "a_over_R", "mu", "T_a2_over_B_frictionless_leading", "T_a2_over_B_tightening_upper", "T_a2_over_B_loosening_lower", "T_a2_over_B_frictionless_first_order(derived_here)", "friction_over_elastic_ratio", "self_locks_without_tension_at_leading_order"], rows)
    ex = []
    for name, d, E in (("soft_test_rod", 1e-3, 1e6), ("polymer_0.225mm_E2GPa", 0.225e-3, 2e9)):
        B = E*np.pi*d**4/64
        for n, J, e in res[:2]:
            for R in (0.01, 0.02, 0.05, 0.1):
                for mu in (0., 0.05, 0.1):
                    ex.append([name, d, E, B, n, R, d/R, mu, B/(2*R*R), B/(2*R*R)*(1+3*J/(2*np.pi)*np.sqrt(d/R)), mu*J/2*B/np.sqrt(d)/R**1.5])
    wcsv("07_elastic_knot_dimensional_examples.csv", ["case", "d_m", "E_Pa", "B_Nm2", "n", "R_m(excess_length/2pi)", "d_over_R", "mu", "T_leading_N", "T_frictionless_first_order_N(derived_here)", "friction_term_plus_minus_N"], ex)

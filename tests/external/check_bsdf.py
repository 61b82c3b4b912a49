"""Checks of appendix_b.py by itself: density (χ²), reciprocity, energy, and its albedo against plain quadrature.

    python check_bsdf.py        exit code 0 when all pass, 1 otherwise

Energy: metals reflect at most what arrives. Dielectrics of Appendix B do not promise that: their base layer is weighted
by 1 − F(v·h) with the half vector of the *outgoing pair*, so at grazing views a white dielectric reflects more than it
receives (1.30 at roughness 0.1, cos 0.2). The check for them is the quadrature, which is written in float64 NumPy from
the formulas and shares no code with the plugin.
"""

import itertools
import sys

import numpy as np

import appendix_b
from variant import dr, mi

ROUGHNESS = (0.1, 0.25, 0.5, 1.0)
METALLIC = (0.0, 0.5, 1.0)
COS_VIEW = (1.0, 0.7, 0.2)
SIGNIFICANCE = 0.01
TINTED = {'ior': 1.8, 'specular': 0.6, 'specular_color': (1.0, 0.4, 0.2)}


class MirrorDomain:
    """Directions round the mirror direction, finer towards it: t = √(|d − axis| / 2), so 1 − cos = 2 t⁴."""

    def __init__(self, axis):
        self.axis = axis
        self.frame = mi.Frame3f(axis)

    def bounds(self):
        return mi.ScalarBoundingBox2f([-np.pi, 0.0], [np.pi, 1.0])

    def aspect(self):
        return 1.0

    def map_forward(self, p):
        one_minus_cos = 2.0 * p.y**4
        sin_theta = dr.safe_sqrt(one_minus_cos * (2.0 - one_minus_cos))
        sin_phi, cos_phi = dr.sincos(p.x)
        return self.frame.to_world(mi.Vector3f(cos_phi * sin_theta, sin_phi * sin_theta, 1.0 - one_minus_cos))

    def map_backward(self, d):
        local = self.frame.to_local(d)
        return mi.Vector2f(dr.atan2(local.y, local.x), self.polar(d))

    def polar(self, d):
        return dr.sqrt(0.5 * dr.norm(d - self.axis))

    def jacobian(self, d):
        """Solid angle by unit of (φ, t)."""
        return 8.0 * self.polar(d)**3


class SphereDomain(mi.chi2.SphericalDomain):
    def jacobian(self, d):
        return 1.0


def material(roughness, metallic, base=(0.8, 0.5, 0.3), **more):
    more = {key: mi.ScalarColor3f(*value) if isinstance(value, tuple) else value for key, value in more.items()}
    return mi.load_dict({'type': 'gltf_pbr', 'roughness': roughness, 'metallic': metallic,
                         'base_color': {'type': 'rgb', 'value': list(base)}, **more})


def interaction(wi):
    si = dr.zeros(mi.SurfaceInteraction3f, dr.width(wi))
    si.sh_frame = mi.Frame3f(mi.Vector3f(0, 0, 1))
    si.wi = wi
    return si


def view(cos_theta, sign=1.0):
    return mi.Vector3f(float(np.sqrt(1 - cos_theta**2)), 0.0, sign * cos_theta)


def directions(count, seed):
    """Uniform on the upper hemisphere; the density is 1 / 2π."""
    rng = mi.PCG32(size=count, initstate=seed)
    return mi.warp.square_to_uniform_hemisphere(mi.Point2f(rng.next_float32(), rng.next_float32()))


def chi_square(bsdf, roughness, cos_theta, sign, tests):
    """Does sample() draw from pdf()? Draws below the horizon carry no light and are left out of the histogram."""
    context = mi.BSDFContext()
    wi = view(cos_theta, sign)
    domain = MirrorDomain(mi.Vector3f(-wi.x, -wi.y, wi.z)) if roughness < 0.2 else SphereDomain()

    def draw(u):
        bs, _ = bsdf.sample(context, interaction(dr.repeat(wi, dr.width(u))), u.x, mi.Point2f(u.y, u.z))
        return bs.wo, dr.select(bs.pdf > 0, mi.Float(1), mi.Float(0))

    def density(wo):
        return bsdf.pdf(context, interaction(dr.repeat(wi, dr.width(wo))), wo) * domain.jacobian(wo)

    test = mi.chi2.ChiSquareTest(domain=domain, sample_func=draw, pdf_func=density, sample_dim=3,
                                 sample_count=400_000, res=101, ires=16)
    passed = test.run(significance_level=SIGNIFICANCE, test_count=tests, quiet=True)
    return passed, float(np.asarray(test.p_value).ravel()[0])


def reciprocity(bsdf):
    """Largest relative difference of f(v, l) and f(l, v)."""
    context = mi.BSDFContext()
    v, l = directions(20_000, 1), directions(20_000, 2)
    one = np.array(bsdf.eval(context, interaction(v), l) / l.z)
    other = np.array(bsdf.eval(context, interaction(l), v) / v.z)
    return float(np.max(np.abs(one - other) / np.maximum(np.maximum(one, other), 1e-6)))


def albedo_sampled(bsdf, cos_theta, count=1_000_000):
    """What a white furnace shows at cos_theta, by sample(): mean and standard error by channel."""
    rng = mi.PCG32(size=count, initstate=3)
    si = interaction(dr.repeat(view(cos_theta), count))
    u = [rng.next_float32() for _ in range(3)]
    _, weight = bsdf.sample(mi.BSDFContext(), si, u[0], mi.Point2f(u[1], u[2]))
    weight = np.array(weight, dtype=np.float64)
    return weight.mean(axis=1), weight.std(axis=1) / np.sqrt(count)


def albedo_quadrature(roughness, metallic, cos_theta, base, ior=1.5, specular=1.0, specular_color=(1, 1, 1)):
    """The same by midpoint rule over the half vector for the specular part and over l for the diffuse part."""
    a2 = max(roughness**2, 1e-3)**2
    v = np.array([np.sqrt(1 - cos_theta**2), 0.0, cos_theta])
    base, f90 = np.array(base), specular
    f0 = np.minimum(((ior - 1) / (ior + 1))**2 * np.array(specular_color), 1.0) * specular
    n = 1024
    mid = (np.arange(n) + 0.5) / n
    phi = 2 * np.pi * mid[None, :]

    def spread(cos):
        sin = np.sqrt(np.maximum(1 - cos**2, 0))
        return np.stack([sin * np.cos(phi), sin * np.sin(phi), cos + 0 * phi])

    def fresnel(low, high, vh):
        return low[:, None, None] + (high - low)[:, None, None] * (1 - np.abs(vh))**5

    # Half vectors by the inverse of the distribution D·cos: each cell holds the same share of it.
    cos_h = np.sqrt((1 - mid) / (1 + (a2 - 1) * mid))[:, None]
    h = spread(cos_h)
    vh = np.einsum('i,ijk->jk', v, h)
    l = 2 * vh * h - v[:, None, None]
    nl = l[2]
    ok = (nl > 0) & (vh > 0)
    nl = np.where(ok, nl, 1.0)

    def root(cos):
        return np.sqrt(a2 + (1 - a2) * cos**2)

    g2 = 2 * nl * cos_theta / (nl * root(cos_theta) + cos_theta * root(nl))
    # ∫ F D G2 / (4 nl nv) nl dω_l with dω_l = 4 vh dω_h and D dω_h = (cell share) / cos_h.
    part = np.where(ok, g2 * vh / (cos_theta * cos_h), 0.0)
    dielectric = (fresnel(f0, f90 * np.ones(3), vh) * part).mean(axis=(1, 2))
    metal = (fresnel(base, np.ones(3), vh) * part).mean(axis=(1, 2))
    l = spread(np.sqrt(mid)[:, None])
    h = v[:, None, None] + l
    vh = np.einsum('i,ijk->jk', v, h) / np.linalg.norm(h, axis=0)
    dielectric += base * (1 - fresnel(f0, f90 * np.ones(3), vh).max(axis=0)).mean()
    return (1 - metallic) * dielectric + metallic * metal


def main():
    appendix_b.register()
    failures = 0

    def verdict(name, passed, detail):
        nonlocal failures
        failures += not passed
        print(f'{"ok  " if passed else "FAIL"} {name}: {detail}')

    grid = list(itertools.product(ROUGHNESS, METALLIC, COS_VIEW))
    cases = [(r, m, c, 1.0) for r, m, c in grid] + [(0.4, 0.3, 0.6, -1.0)]
    for r, m, c, sign in cases:
        passed, p = chi_square(material(r, m), r, c, sign, len(cases))
        verdict(f'chi2 roughness {r} metallic {m} cos {sign * c:+.1f}', passed, f'p = {p:.3f}')
    for r, m in itertools.product(ROUGHNESS, METALLIC):
        for label, more in (('', {}), (' ior/specular', TINTED)):
            worst = reciprocity(material(r, m, **more))
            verdict(f'reciprocity roughness {r} metallic {m}{label}', worst < 1e-4, f'largest difference {worst:.1e}')
    for r, m, c in grid:
        white, error = albedo_sampled(material(r, m, base=(1, 1, 1)), c)
        if m == 1.0:
            verdict(f'energy roughness {r} cos {c}', white.max() <= 1 + 4 * error.max(), f'albedo {white.max():.4f}')
        for label, base, more in ((' white', (1, 1, 1), {}), (' ior/specular', (0.8, 0.5, 0.3), TINTED)):
            sampled, error = albedo_sampled(material(r, m, base=base, **more), c)
            exact = albedo_quadrature(r, m, c, base, **more)
            z = np.max(np.abs(sampled - exact) / np.hypot(error, 2e-5))
            verdict(f'albedo roughness {r} metallic {m} cos {c}{label}', z < 4.5,
                    f'{sampled[0]:.4f}, quadrature {exact[0]:.4f}, z = {z:.2f}')
    print(f'{failures} failed' if failures else 'all passed')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())

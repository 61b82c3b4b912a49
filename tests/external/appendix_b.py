"""The metallic-roughness surface of glTF 2.0 as a Mitsuba BSDF, written from the specification.

Sources
  [B]   glTF 2.0 specification, Appendix B "BRDF Implementation".
  [IOR] KHR_materials_ior, [SPEC] KHR_materials_specular.
  [H14] Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 2014.
  [H18] Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 2018.

One deliberate reading: [B] prints the masking-shadowing term of GGX as a product of two factors; here it is the
height-correlated form of [H14] eq. 99, which the glTF sample renderers use.

Directions point away from the surface: v is the one that Mitsuba calls wi (towards the viewer), l is wo. Both sides of
a surface reflect; the frame is turned towards the viewer. `alpha` is held at 1e-3 or more (roughness 0.03).

Opacity is not part of the reflectance: `eval_null_transmission` reports it, and the integrator (window_path.py) decides
at each hit whether the surface is there. So a hole counts as no bounce.
"""

from variant import dr, mi

ALPHA_MIN = 1e-3


def schlick(f0, f90, v_dot_h):
    """Fresnel after Schlick, [B] and [SPEC]."""
    x = dr.clip(1.0 - dr.abs(v_dot_h), 0.0, 1.0)
    return f0 + (f90 - f0) * dr.square(dr.square(x)) * x


def ggx_d(h, alpha):
    """Normal distribution D of GGX; written with sin² = x² + y² so that small alpha loses no digits."""
    a2 = dr.square(alpha)
    return a2 / (dr.pi * dr.square(dr.square(h.x) + dr.square(h.y) + a2 * dr.square(h.z)))


def smith_root(cos_theta, a2):
    """√(α² + (1 − α²) cos²), which is cos · (1 + 2Λ)."""
    return dr.sqrt(a2 + (1.0 - a2) * dr.square(cos_theta))


def ggx_v(n_dot_l, n_dot_v, alpha):
    """Height-correlated G2 / (4 n·l n·v)."""
    a2 = dr.square(alpha)
    return 0.5 * dr.rcp(n_dot_l * smith_root(n_dot_v, a2) + n_dot_v * smith_root(n_dot_l, a2))


def visible_normal_pdf_reflected(v, h, alpha):
    """Solid-angle density of l = reflect(v, h), h drawn from the visible normals: G1(v) D(h) / (4 n·v)."""
    return 0.5 * ggx_d(h, alpha) * dr.rcp(v.z + smith_root(v.z, dr.square(alpha)))


def sample_visible_normal(v, alpha, u):
    """[H18] listing 1."""
    stretched = dr.normalize(mi.Vector3f(alpha * v.x, alpha * v.y, v.z))
    length2 = dr.square(stretched.x) + dr.square(stretched.y)
    t1 = dr.select(length2 > 1e-12, mi.Vector3f(-stretched.y, stretched.x, 0.0) * dr.rsqrt(dr.maximum(length2, 1e-12)),
                   mi.Vector3f(1.0, 0.0, 0.0))
    t2 = dr.cross(stretched, t1)
    radius = dr.sqrt(u.x)
    sin_phi, cos_phi = dr.sincos(dr.two_pi * u.y)
    p1 = radius * cos_phi
    blend = 0.5 * (1.0 + stretched.z)
    p2 = dr.lerp(dr.safe_sqrt(1.0 - dr.square(p1)), radius * sin_phi, blend)
    p3 = dr.safe_sqrt(1.0 - dr.square(p1) - dr.square(p2))
    n = p1 * t1 + p2 * t2 + p3 * stretched
    return dr.normalize(mi.Vector3f(alpha * n.x, alpha * n.y, dr.maximum(n.z, 1e-6)))


class AppendixB(mi.BSDF):
    """Plugin `gltf_pbr`.

    base_color  texture or colour      metallic, roughness  texture or number
    opacity     texture or number      cutoff              alphaMode MASK: a hole below it (−1: opacity is coverage)
    normal_map  texture of raw RGB     normal_scale        number
    ior, specular, specular_color      numbers, see [IOR] and [SPEC]
    vertex_color                       true: base_color is multiplied by the mesh attribute `vertex_color`, opacity by
                                       `vertex_opacity`
    vertex_tangent                     true: the normal map's frame is the mesh attributes `vertex_tangent` and
                                       `vertex_handedness`, else it follows the texture coordinates
    """

    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        self.base_color = props.get_texture('base_color', 1.0)
        self.metallic = props.get_texture('metallic', 1.0)
        self.roughness = props.get_texture('roughness', 1.0)
        self.opacity = props.get_texture('opacity', 1.0) if props.has_property('opacity') else None
        self.cutoff = props.get('cutoff', -1.0)
        self.normal_map = props.get_texture('normal_map') if props.has_property('normal_map') else None
        self.normal_scale = mi.Float(props.get('normal_scale', 1.0))
        self.vertex_color = props.get('vertex_color', False)
        self.vertex_tangent = props.get('vertex_tangent', False)
        self.f0, self.f90 = dielectric_f0_f90(props)
        # Opaque values keep every instance's code equal, so that Dr.Jit compiles it once.
        dr.make_opaque(self.normal_scale, self.f0, self.f90)

        reflection = mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
        self.m_components = [mi.BSDFFlags.DiffuseReflection | reflection, mi.BSDFFlags.GlossyReflection | reflection]
        if self.opacity is not None:
            self.m_components = [*self.m_components, mi.BSDFFlags.Null | reflection]
        flags = self.m_components[0]
        for component in self.m_components[1:]:
            flags = flags | component
        self.m_flags = flags

    # What the material is at a point

    def _parameters(self, si, active):
        base = self.base_color.eval(si, active)
        if self.vertex_color:
            base = base * si.shape.eval_attribute_3('vertex_color', si, active)
        metallic = self.metallic.eval_1(si, active)
        alpha = dr.maximum(dr.square(self.roughness.eval_1(si, active)), ALPHA_MIN)
        return base, metallic, alpha

    def _frame(self, si, active):
        """Local frame to work in: the normal map's, else the interpolated one, as (to, back)."""
        if self.normal_map is None:
            return (lambda d: d), (lambda d: d)
        texel = 2.0 * self.normal_map.eval(si, active) - 1.0
        bent = mi.Vector3f(texel.x * self.normal_scale, texel.y * self.normal_scale, texel.z)
        tangent, bitangent = self._tangents(si, active)
        normal = dr.normalize(tangent * bent.x + bitangent * bent.y + mi.Vector3f(0.0, 0.0, bent.z))
        frame = mi.Frame3f(normal)
        return frame.to_local, frame.to_world

    def _tangents(self, si, active):
        """Local directions of a normal map's x and y, both orthogonal to the shading normal."""
        along = si.shape.eval_attribute_3('vertex_tangent', si, active) if self.vertex_tangent else si.dp_du
        tangent = si.to_local(mi.Vector3f(along))
        tangent = dr.normalize(mi.Vector3f(tangent.x, tangent.y, 0.0))
        bitangent = mi.Vector3f(-tangent.y, tangent.x, 0.0)
        if self.vertex_tangent:
            flipped = si.shape.eval_attribute_1('vertex_handedness', si, active) < 0.0
        else:
            # glTF's images have v growing downwards, its normal maps y growing upwards.
            flipped = dr.dot(bitangent, si.to_local(si.dp_dv)) > 0.0
        return tangent, dr.select(flipped, -bitangent, bitangent)

    # The reflectance in a frame where v.z > 0, times n·l

    def _value(self, base, metallic, alpha, v, l):
        h = dr.normalize(v + l)
        v_dot_h = dr.dot(v, h)
        specular = ggx_v(l.z, v.z, alpha) * ggx_d(h, alpha)
        dielectric_f = schlick(self.f0, self.f90, v_dot_h)
        dielectric = (1.0 - dr.max(dielectric_f)) * base * dr.inv_pi + dielectric_f * specular
        metal = schlick(base, mi.Color3f(1.0), v_dot_h) * specular
        return dr.lerp(dielectric, metal, metallic) * l.z

    def _specular_share(self, base, metallic, v):
        """Chance of drawing from the specular lobe: a guess of its share of the reflected light, never 0 or 1."""
        fresnel = schlick(dr.lerp(self.f0, base, metallic), mi.Color3f(1.0), v.z)
        specular = dr.mean(fresnel)
        diffuse = (1.0 - metallic) * dr.mean((1.0 - fresnel) * base)
        return dr.clip(specular / dr.maximum(specular + diffuse, 1e-6), 0.1, 0.95)

    def _density(self, share, alpha, v, l):
        h = dr.normalize(v + l)
        return dr.lerp(l.z * dr.inv_pi, visible_normal_pdf_reflected(v, h, alpha), share)

    # Mitsuba's interface

    def _evaluate(self, si, wo, active):
        base, metallic, alpha = self._parameters(si, active)
        to_local, _ = self._frame(si, active)
        side = dr.copysign(mi.Float(1.0), si.wi.z)
        v, l = to_local(si.wi) * side, to_local(wo) * side
        active = active & (wo.z * si.wi.z > 0.0) & (v.z > 0.0) & (l.z > 0.0)
        share = self._specular_share(base, metallic, v)
        value = self._value(base, metallic, alpha, v, l)
        pdf = self._density(share, alpha, v, l)
        return dr.select(active, value, 0.0), dr.select(active, pdf, 0.0)

    def sample(self, ctx, si, sample1, sample2, active=True):
        base, metallic, alpha = self._parameters(si, active)
        to_local, back = self._frame(si, active)
        side = dr.copysign(mi.Float(1.0), si.wi.z)
        v = to_local(si.wi) * side
        share = self._specular_share(base, metallic, v)
        glossy = sample1 < share
        h = sample_visible_normal(v, alpha, sample2)
        l = dr.select(glossy, 2.0 * dr.dot(v, h) * h - v, mi.warp.square_to_cosine_hemisphere(sample2))

        bs = dr.zeros(mi.BSDFSample3f)
        bs.wo = back(l) * side
        bs.eta = 1.0
        bs.sampled_type = dr.select(glossy, +mi.BSDFFlags.GlossyReflection, +mi.BSDFFlags.DiffuseReflection)
        bs.sampled_component = dr.select(glossy, mi.UInt32(1), mi.UInt32(0))
        active = active & (bs.wo.z * si.wi.z > 0.0) & (v.z > 0.0) & (l.z > 0.0)
        bs.pdf = dr.select(active, self._density(share, alpha, v, l), 0.0)
        active = active & (bs.pdf > 0.0)
        value = self._value(base, metallic, alpha, v, l)
        return bs, dr.select(active, value / bs.pdf, 0.0)

    def eval(self, ctx, si, wo, active=True):
        return self._evaluate(si, wo, active)[0]

    def pdf(self, ctx, si, wo, active=True):
        return self._evaluate(si, wo, active)[1]

    def eval_pdf(self, ctx, si, wo, active=True):
        return self._evaluate(si, wo, active)

    def eval_pdf_sample(self, ctx, si, wo, sample1, sample2, active=True):
        value, pdf = self._evaluate(si, wo, active)
        bs, weight = self.sample(ctx, si, sample1, sample2, active)
        return value, pdf, bs, weight

    def eval_null_transmission(self, si, active=True):
        if self.opacity is None:
            return mi.Color3f(0.0)
        opacity = self.opacity.eval_1(si, active)
        if self.vertex_color:
            opacity = opacity * si.shape.eval_attribute_1('vertex_opacity', si, active)
        if self.cutoff >= 0.0:
            opacity = dr.select(opacity >= self.cutoff, 1.0, 0.0)
        return mi.Color3f(1.0 - opacity)

    def eval_diffuse_reflectance(self, si, active=True):
        return self.base_color.eval(si, active)

    def eval_attribute_3(self, name, si, active=True):
        """`unlit`: what the surface shows to the camera without light."""
        return mi.Color3f(0.0)

    def to_string(self):
        return 'AppendixB[]'


class Unlit(AppendixB):
    """Plugin `gltf_unlit`, KHR_materials_unlit: shows its base colour to the camera; to light it is a black body."""

    def _value(self, base, metallic, alpha, v, l):
        return mi.Color3f(0.0)

    def eval_attribute_3(self, name, si, active=True):
        return self._parameters(si, active)[0]

    def to_string(self):
        return 'Unlit[]'


def dielectric_f0_f90(props):
    """F0 and F90 of the dielectric half: [IOR] and [SPEC]."""
    ior = props.get('ior', 1.5)
    strength = props.get('specular', 1.0)
    tint = mi.ScalarColor3f(props.get('specular_color', mi.ScalarColor3f(1.0)))
    normal_incidence = ((ior - 1.0) / (ior + 1.0)) ** 2
    f0 = [min(normal_incidence * channel, 1.0) * strength for channel in tint]
    return mi.Color3f(f0), mi.Color3f(strength)


def register():
    """Makes the plugins known to Mitsuba; call once."""
    mi.register_bsdf('gltf_pbr', AppendixB)
    mi.register_bsdf('gltf_unlit', Unlit)

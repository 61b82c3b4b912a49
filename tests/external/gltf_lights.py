"""The lights of glTF that Mitsuba's own emitters do not cover.

Sources
  [STRENGTH] KHR_materials_emissive_strength   [PUNCTUAL] KHR_lights_punctual, sections "Range Property" and
  "Inner and Outer Cone Angles".
Units: emissiveFactor × emissiveStrength is radiance; a punctual light's colour × intensity is radiant intensity.
"""

from variant import dr, mi


class SurfaceLight(mi.Emitter):
    """Plugin `gltf_surface`: `radiance` may be a texture; `double_sided` lets the back shine, too."""

    def __init__(self, props):
        super().__init__(props)
        self.radiance = props.get_emissive_texture('radiance', 1.0)
        self.double_sided = props.get('double_sided', False)
        self.m_flags = +mi.EmitterFlags.Surface | +mi.EmitterFlags.SpatiallyVarying

    def traverse(self, callback):
        callback.put('radiance', self.radiance, mi.ParamFlags.Differentiable)

    def _shines(self, cos_theta):
        return (cos_theta != 0) if self.double_sided else (cos_theta > 0)

    def eval(self, si, active=True):
        return dr.select(self._shines(mi.Frame3f.cos_theta(si.wi)), self.radiance.eval(si, active), 0)

    def sample_direction(self, it, sample, active=True):
        ds = self.get_shape().sample_direction(it, sample, active)
        active = active & self._shines(-dr.dot(ds.d, ds.n)) & (ds.pdf > 0)
        si = mi.SurfaceInteraction3f(ds, it.wavelengths)
        value = self.radiance.eval(si, active) / ds.pdf
        ds.pdf = dr.select(active, ds.pdf, 0)
        return ds, dr.select(active, value, 0)

    def pdf_direction(self, it, ds, active=True):
        active = active & self._shines(-dr.dot(ds.d, ds.n))
        return dr.select(active, self.get_shape().pdf_direction(it, ds, active), 0)

    def eval_direction(self, it, ds, active=True):
        si = mi.SurfaceInteraction3f(ds, it.wavelengths)
        return dr.select(active & self._shines(-dr.dot(ds.d, ds.n)), self.radiance.eval(si, active), 0)

    def bbox(self):
        return self.get_shape().bbox()

    def to_string(self):
        return 'SurfaceLight[]'


class PunctualLight(mi.Emitter):
    """Plugin `gltf_punctual`: `position`, `direction` (unit), `intensity` (W/sr), `range` (0: infinite),
    `cos_inner`, `cos_outer` (−2, −2: a point light)."""

    def __init__(self, props):
        super().__init__(props)
        self.position = mi.Point3f(mi.ScalarPoint3f(props['position']))
        self.direction = mi.Vector3f(mi.ScalarVector3f(props['direction']))
        self.intensity = mi.Color3f(mi.ScalarColor3f(props['intensity']))
        self.range = mi.Float(props.get('range', 0.0))
        self.cos_inner = mi.Float(props.get('cos_inner', -2.0))
        self.cos_outer = mi.Float(props.get('cos_outer', -2.0))
        dr.make_opaque(self.position, self.direction, self.intensity, self.range, self.cos_inner, self.cos_outer)
        self.m_flags = +mi.EmitterFlags.DeltaPosition
        self.m_needs_sample_3 = False

    def traverse(self, callback):
        pass

    def _falloff(self, cos_theta, distance):
        """[PUNCTUAL]: the cone's scale and offset form, squared; the windowed inverse square."""
        scale = dr.rcp(dr.maximum(0.001, self.cos_inner - self.cos_outer))
        cone = dr.square(dr.clip(cos_theta * scale - self.cos_outer * scale, 0, 1))
        cone = dr.select(self.cos_outer <= -1, 1, cone)
        window = dr.clip(1 - dr.square(dr.square(distance / self.range)), 0, 1)
        window = dr.select(self.range > 0, window, 1)
        return cone * window * dr.rcp(dr.square(distance))

    def sample_direction(self, it, sample, active=True):
        ds = dr.zeros(mi.DirectionSample3f)
        ds.p = self.position
        to_light = ds.p - it.p
        ds.dist = dr.norm(to_light)
        ds.d = to_light / ds.dist
        ds.n = -ds.d
        ds.time = it.time
        ds.pdf = mi.Float(1)
        ds.delta = mi.Bool(True)
        return ds, dr.select(active, self.intensity * self._falloff(-dr.dot(ds.d, self.direction), ds.dist), 0)

    def pdf_direction(self, it, ds, active=True):
        return mi.Float(0)

    def eval_direction(self, it, ds, active=True):
        return self.intensity * self._falloff(-dr.dot(ds.d, self.direction), ds.dist)

    def eval(self, si, active=True):
        return mi.Color3f(0)

    def bbox(self):
        return mi.ScalarBoundingBox3f()

    def to_string(self):
        return 'PunctualLight[]'


def register():
    """Makes the plugins known to Mitsuba; call once."""
    mi.register_emitter('gltf_surface', SurfaceLight)
    mi.register_emitter('gltf_punctual', PunctualLight)

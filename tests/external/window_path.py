"""A path integrator for Mitsuba that keeps only the light paths inside a window of bounces.

A path's bounces are its scatterings between the emitter and the camera:

    emission    0           camera – emitter
    direct      1           camera – x1 – emitter
    indirect:N  2 … N + 1   one to N further bounces
    full:N      0 … N + 1   all of these

Unidirectional, next-event estimation and BSDF sampling combined by the power heuristic, no Russian roulette.
Surfaces with opacity are there or not by a coin toss at each hit (BSDF.eval_null_transmission), shadow rays are
multiplied by the transmission; neither counts a bounce. Unlit surfaces count as emission, seen by the camera alone.
"""

import re

from variant import dr, mi


def window(transport):
    """(fewest, most) bounces of a transport label."""
    if transport == 'emission':
        return 0, 0
    if transport == 'direct':
        return 1, 1
    match = re.fullmatch(r'(indirect|full):(\d+)', transport)
    if not match or (match[1] == 'indirect' and int(match[2]) < 1):
        raise ValueError(f'unknown transport "{transport}": emission, direct, indirect:N (N ≥ 1) or full:N')
    return (2 if match[1] == 'indirect' else 0), int(match[2]) + 1


def power_heuristic(pdf, other):
    square = dr.square(pdf)
    return dr.select(pdf > 0, square / (square + dr.square(other)), 0)


class WindowPath(mi.SamplingIntegrator):
    """Plugin `window_path` with `fewest` and `most` bounces; `see_through`, `unlit`: whether any surface is so."""

    def __init__(self, props):
        super().__init__(props)
        self.fewest = props.get('fewest', 0)
        self.most = props.get('most', 1)
        self.see_through = props.get('see_through', False)
        self.unlit = props.get('unlit', False)

    def traverse(self, callback):
        pass

    @dr.syntax
    def nearest(self, scene, sampler, ray, active):
        """The first surface that is there."""
        si = scene.ray_intersect(ray, active)
        if dr.hint(self.see_through, mode='scalar'):
            searching = mi.Bool(active)
            while searching:
                transmission = si.bsdf().eval_null_transmission(si, searching & si.is_valid())
                searching &= si.is_valid() & (sampler.next_1d(searching) < transmission.x)
                beyond = scene.ray_intersect(si.spawn_ray(ray.d), searching)
                si = dr.select(searching, beyond, si)
        return si

    @dr.syntax
    def transmission(self, scene, ray, active):
        """What a shadow ray keeps."""
        kept = mi.Float(1)
        if dr.hint(self.see_through, mode='scalar'):
            ray = mi.Ray3f(ray)
            searching = mi.Bool(active)
            while searching:
                si = scene.ray_intersect(ray, searching)
                searching &= si.is_valid()
                kept[searching] = kept * si.bsdf().eval_null_transmission(si, searching).x
                searching &= kept > 0
                left = ray.maxt - si.t
                ray = si.spawn_ray(ray.d)
                ray.maxt = left
        else:
            kept = dr.select(scene.ray_test(ray, active), mi.Float(0), mi.Float(1))
        return kept

    @dr.syntax
    def sample(self, scene, sampler, ray, medium=None, active=True):
        context = mi.BSDFContext()
        ray = mi.Ray3f(ray)
        active = mi.Bool(active)
        radiance = mi.Spectrum(0)
        throughput = mi.Spectrum(1)
        bounces = mi.UInt32(0)
        before = dr.zeros(mi.Interaction3f)
        before_pdf = mi.Float(0)
        hit_something = mi.Bool(False)

        while active:
            si = self.nearest(scene, sampler, ray, active)
            hit_something |= active & (bounces == 0) & si.is_valid()

            # The emitter at the end of this segment, against next-event estimation at its start.
            here = mi.DirectionSample3f(scene, si, before)
            pdf_light = scene.pdf_emitter_direction(before, here, active & (bounces > 0))
            weight = dr.select(bounces > 0, power_heuristic(before_pdf, pdf_light), 1)
            wanted = active & (bounces >= self.fewest)
            emitter = si.emitter(scene, active)
            radiance[wanted] = radiance + throughput * weight * emitter.eval(si, wanted)

            if dr.hint(self.unlit, mode='scalar'):
                shown = wanted & si.is_valid() & (bounces == 0)
                radiance[shown] = radiance + si.bsdf().eval_attribute_3('unlit', si, shown)

            active &= si.is_valid() & (bounces < self.most)
            bounces += 1

            # Next-event estimation.
            bsdf = si.bsdf()
            ds, incoming = scene.sample_emitter_direction(si, sampler.next_2d(active), False, active)
            wanted = active & (bounces >= self.fewest) & (ds.pdf > 0)
            wo = si.to_local(ds.d)
            value, pdf_bsdf, bs, bsdf_weight = bsdf.eval_pdf_sample(
                context, si, wo, sampler.next_1d(active), sampler.next_2d(active), active)
            weight = dr.select(ds.delta, 1, power_heuristic(ds.pdf, pdf_bsdf))
            wanted &= dr.max(value) > 0
            kept = self.transmission(scene, si.spawn_ray_to(ds.p), wanted)
            radiance[wanted] = radiance + throughput * value * incoming * weight * kept

            # On along the BSDF's draw.
            throughput *= bsdf_weight
            active &= dr.max(throughput) > 0
            ray = si.spawn_ray(si.to_world(bs.wo))
            before = mi.Interaction3f(si.t, si.time, si.wavelengths, si.p, si.n)
            before_pdf = bs.pdf

        return radiance, hit_something, []

    def to_string(self):
        return f'WindowPath[{self.fewest}..{self.most}]'


def register():
    """Makes `window_path` known to Mitsuba; call once."""
    mi.register_integrator('window_path', WindowPath)

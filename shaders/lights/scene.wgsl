//! Fills slot `lights`: the lights of the scene: emissive triangles, punctual lights, the environment.
//!
//! A light is sampled in its own uv ∈ [0, 1)²: area-uniform on a triangle, importance-warped on the environment, without meaning
//! for punctual lights. `Arrival.value` is the integrand's light part in that measure, so that a technique which draws light l
//! with probability P(l) and uniform uv has the estimator  f·cos · value / P(l)  (times visibility).
//! @default

import package::base::math::{HUGE, PI, luminance, max3};
import package::base::sampling::{triangle_uv};
@if(emissive_meshes) import package::base::sampling::{sample_triangle};
import package::frame::frame::{NOW, frame};
import package::scene::geometry::{NONE};
@if(emissive_meshes) import package::scene::geometry::{info_of, instance_at, is_solid, point_to_world, triangle_at};
@if(emissive_meshes) import package::scene::material::{emission_at};
@if(emissive_meshes && alpha) import package::scene::material::{opacity_at};
@if(emissive_meshes && double_sided) import package::scene::material::{DOUBLE_SIDED, stored_material};
import package::scene::ray::{Hit, Ray, RELATIVE_ERROR};
@if(environment) import package::scene::environment::{environment_direction, environment_jacobian, environment_radiance, environment_uv};
@if(punctual_lights) import package::scene::punctual::{Punctual, punctual_at, punctual_falloff};

struct Light {
    kind: u32,
    /// Instance of a triangle, index of a punctual light.
    index: u32,
    triangle: u32,
    /// Probability proportional to emitted power.
    pmf: f32,
    /// Vose's alias table: the entry keeps itself below `threshold`, else it is `other`.
    threshold: f32,
    other: u32,
}

const TRIANGLE: u32 = 0u;
const PUNCTUAL: u32 = 1u;
const ENVIRONMENT: u32 = 2u;

@group(0) @binding(0) var<storage, read> lights: array<Light>;

/// One point of a light.
struct LightPoint {
    /// World position; of lights at infinity, the unit direction towards them.
    position: vec3<f32>,
    infinite: bool,
    /// Unit normal of the emitting side; 0 where the light has none.
    normal: vec3<f32>,
    /// World area of a triangle, 0 where its instance is squashed flat; of the environment dω/duv; 0 for punctual lights.
    area: f32,
    /// Only light sampling meets it: a punctual light.
    delta: bool,
    /// Radiance of triangle or environment, intensity of point and spot, irradiance of a directional light.
    emission: vec3<f32>,
    /// Share of the rays towards it that end there: the others go through a hole, where nothing shines. It is in `emission`.
    @if(alpha) opacity: f32,
    double_sided: bool,
    size: f32,
    light: u32,
    /// The world that the point is in.
    when: u32,
}

/// What a light point sends to a receiver, before the BSDF and visibility.
struct Arrival {
    /// Unit, from receiver to light.
    direction: vec3<f32>,
    /// The light part of the integrand by uv: radiance · dω/duv.
    value: vec3<f32>,
    /// dω/duv at the receiver; 0 for punctual lights.
    jacobian: f32,
}

fn light_count() -> u32 {
    return frame.lights;
}

fn light_point(id: u32, uv: vec2<f32>, when: u32) -> LightPoint {
    let light = lights[id];
    var p: LightPoint;
    p.light = id;
    p.when = when;
    @if(alpha) { p.opacity = 1.0; }
    @if(punctual_lights) {
        if (light.kind == PUNCTUAL) {
            let l = punctual_at(light.index, when);
            p.delta = true;
            p.infinite = l.kind == 0u;
            p.position = select(l.position, -l.direction, p.infinite);
            p.emission = l.intensity;
            return p;
        }
    }
    @if(environment) {
        if (light.kind == ENVIRONMENT) {
            p.infinite = true;
            p.position = environment_direction(uv);
            p.area = environment_jacobian(p.position);
            p.emission = environment_radiance(p.position);
            return p;
        }
    }
    @if(emissive_meshes) { return triangle_point(light, id, sample_triangle(uv), when); }
    return p;
}

@if(emissive_meshes) fn triangle_point(light: Light, id: u32, barycentrics: vec2<f32>, when: u32) -> LightPoint {
    let instance = instance_at(light.index, when);
    let t = triangle_at(light.triangle);
    let a = point_to_world(instance, t.a);
    let b = point_to_world(instance, t.b);
    let c = point_to_world(instance, t.c);
    let n = cross(b - a, c - a) * select(1.0, -1.0, instance.mirrored != 0u);
    let material = info_of(light.triangle).material;
    var p: LightPoint;
    p.position = a + barycentrics.x * (b - a) + barycentrics.y * (c - a);
    p.normal = normalize(n);
    // One that was squashed is in no hierarchy and shines nowhere, but may still be remembered.
    p.area = select(0.0, 0.5 * length(n), is_solid(instance));
    p.emission = emission_at(material, light.triangle, barycentrics);
    @if(alpha) {
        p.opacity = opacity_at(material, light.triangle, barycentrics);
        p.emission *= p.opacity;
    }
    @if(double_sided) { p.double_sided = (stored_material(material).flags & DOUBLE_SIDED) != 0u; }
    p.size = max(max3(abs(a)), max(max3(abs(b)), max3(abs(c))));
    p.light = id;
    p.when = when;
    return p;
}

fn arrive(p: LightPoint, from_position: vec3<f32>) -> Arrival {
    if (p.infinite) {
        return Arrival(p.position, p.emission * select(p.area, 1.0, p.delta), p.area);
    }
    let d = p.position - from_position;
    let d2 = dot(d, d);
    if (d2 <= 0.0) { return Arrival(vec3<f32>(0.0, 0.0, 1.0), vec3<f32>(0.0), 0.0); }
    let direction = d * inverseSqrt(d2);
    if (p.delta) { return Arrival(direction, p.emission * (falloff(p, direction, d2) / d2), 0.0); }
    if (p.area == 0.0) { return Arrival(direction, vec3<f32>(0.0), 0.0); }
    let cosine = -dot(p.normal, direction);
    let facing = select(max(cosine, 0.0), abs(cosine), p.double_sided);
    let jacobian = facing * p.area / d2;
    return Arrival(direction, p.emission * jacobian, jacobian);
}

/// Spot cone and range window of a punctual light.
fn falloff(p: LightPoint, direction: vec3<f32>, d2: f32) -> f32 {
    @if(punctual_lights) { return punctual_falloff(lights[p.light].index, direction, d2, p.when); }
    return 1.0;
}

/// The ray whose being clear means that the light point is seen; it ends just before the light. `origin` has left its own surface.
fn shadow_ray(origin: vec3<f32>, p: LightPoint) -> Ray {
    if (p.infinite) { return Ray(origin, HUGE, p.position); }
    let step = RELATIVE_ERROR * max(p.size, max3(abs(p.position)));
    let side = select(-step, step, dot(p.normal, origin - p.position) >= 0.0);
    let d = p.position + p.normal * side - origin;
    let distance = length(d);
    return Ray(origin, distance, d / distance);
}

/// The environment is the last of the lights; `NONE` where there is none, or a black one.
@if(environment) fn environment_light() -> u32 {
    let last = max(light_count(), 1u) - 1u;
    return select(NONE, last, lights[last].kind == ENVIRONMENT);
}

/// Which light a ray's end belongs to, or `NONE`: a ray that hits nothing ends at the environment.
fn light_of(hit: Hit) -> u32 {
    if (hit.instance == NONE) {
        @if(environment) { return environment_light(); }
        return NONE;
    }
    @if(emissive_meshes) {
        let rank = info_of(hit.triangle).emissive;
        if (rank != NONE) { return instance_at(hit.instance, NOW).first_light + rank; }
    }
    return NONE;
}

/// dω/duv of light `id` at a hit of a ray along unit `direction` that began at `origin`.
fn jacobian_of(id: u32, hit: Hit, origin: vec3<f32>, when: u32) -> f32 {
    @if(emissive_meshes) { return arrive(triangle_point(lights[id], id, hit.barycentrics, when), origin).jacobian; }
    return 0.0;
}

/// The uv that `light_point` has a hit at; of a ray that hit nothing, that of its direction.
fn uv_of(hit: Hit, direction: vec3<f32>) -> vec2<f32> {
    @if(environment) {
        if (hit.instance == NONE) { return environment_uv(direction); }
    }
    return triangle_uv(hit.barycentrics);
}

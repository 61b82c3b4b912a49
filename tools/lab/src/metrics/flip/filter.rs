//! The filters of FLIP: what the eye smooths away, and what it picks out. All are separable; edges of the image are repeated outwards.

use std::f32::consts::PI;

/// One number a pixel.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Plane {
    pub(super) size: [usize; 2],
    pub(super) values: Vec<f32>,
}

/// An odd number of weights, the middle one for the pixel itself.
type Kernel = Vec<f32>;

impl Plane {
    /// Filtered across, then down.
    fn filtered(&self, across: &[f32], down: &[f32]) -> Plane {
        self.across(across).down(down)
    }

    fn across(&self, kernel: &[f32]) -> Plane {
        let (width, radius) = (self.size[0], kernel.len() / 2);
        let mut values = vec![0.0; self.values.len()];
        let mut padded = vec![0.0; width + 2 * radius];
        for (row, out) in self.values.chunks_exact(width).zip(values.chunks_exact_mut(width)) {
            padded[..radius].fill(row[0]);
            padded[radius..radius + width].copy_from_slice(row);
            padded[radius + width..].fill(row[width - 1]);
            for (k, weight) in kernel.iter().enumerate() {
                add(out, *weight, &padded[k..k + width]);
            }
        }
        Plane { size: self.size, values }
    }

    fn down(&self, kernel: &[f32]) -> Plane {
        let ([width, height], radius) = (self.size, kernel.len() / 2);
        let mut values = vec![0.0; self.values.len()];
        for (y, out) in values.chunks_exact_mut(width).enumerate() {
            for (k, weight) in kernel.iter().enumerate() {
                let row = (y + k).saturating_sub(radius).min(height - 1);
                add(out, *weight, &self.values[row * width..(row + 1) * width]);
            }
        }
        Plane { size: self.size, values }
    }
}

fn add(out: &mut [f32], weight: f32, row: &[f32]) {
    out.iter_mut().zip(row).for_each(|(out, value)| *out += weight * value);
}

/// Contrast sensitivity as Gaussians, one for the achromatic and the red-green channel each, a sum of two for blue-yellow.
pub(super) struct Smoothing {
    y: Kernel,
    cx: Kernel,
    cz: [Kernel; 2],
}

/// Scale parameters b of a·√(π/b)·exp(−π²x²/b), x in degrees, and the weights a of the sum (HPG 2020, table 1).
const B_Y: f32 = 0.0047;
const B_CX: f32 = 0.0053;
const B_CZ: [f32; 2] = [0.04, 0.025];
const A_CZ: [f32; 2] = [34.1, 13.5];

impl Smoothing {
    pub(super) fn new(pixels_per_degree: f32) -> Self {
        // Three standard deviations of the widest Gaussian.
        let radius = (3.0 * (B_CZ[0] / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i32;
        let gaussian = |weight: f32, b: f32| -> Kernel {
            (-radius..=radius).map(|x| weight * (-PI * PI * (x as f32 / pixels_per_degree).powi(2) / b).exp()).collect()
        };
        // A sum of Gaussians in two dimensions separates term by term, each with the root of its factor both ways. The two-dimensional
        // weights of both terms together sum to 1.
        let [first, second] = [0, 1].map(|i| gaussian((A_CZ[i] * (PI / B_CZ[i]).sqrt()).sqrt(), B_CZ[i]));
        let total = (sum(&first).powi(2) + sum(&second).powi(2)).sqrt();
        let alone = |b| {
            let kernel = gaussian(1.0, b);
            let total = sum(&kernel);
            scaled(kernel, total)
        };
        Self { y: alone(B_Y), cx: alone(B_CX), cz: [scaled(first, total), scaled(second, total)] }
    }

    /// The three opponent channels as they arrive.
    pub(super) fn seen(&self, y: &Plane, cx: &Plane, cz: &Plane) -> [Plane; 3] {
        let [mut both, second] = self.cz.each_ref().map(|kernel| cz.filtered(kernel, kernel));
        add(&mut both.values, 1.0, &second.values);
        [y.filtered(&self.y, &self.y), cx.filtered(&self.cx, &self.cx), both]
    }
}

/// Detectors of edges and points: first and second derivatives of a Gaussian.
pub(super) struct Feature {
    gaussian: Kernel,
    edge: Kernel,
    point: Kernel,
}

/// Width of the detected features in degrees (HPG 2020, section 4.3).
const FEATURE_WIDTH: f32 = 0.082;

impl Feature {
    pub(super) fn new(pixels_per_degree: f32) -> Self {
        let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
        let radius = (3.0 * deviation).ceil() as i32;
        let kernel = |factor: fn(f32) -> f32| -> Kernel {
            (-radius..=radius).map(|x| x as f32 / deviation).map(|x| factor(x) * (-0.5 * x * x).exp()).collect()
        };
        Self { gaussian: balanced(kernel(|_| 1.0)), edge: balanced(kernel(|x| -x)), point: balanced(kernel(|x| x * x - 1.0)) }
    }

    /// Strengths of the edge and of the point at every pixel of an achromatic opponent channel.
    pub(super) fn strengths(&self, y: &Plane) -> impl Iterator<Item = [f32; 2]> + use<> {
        let y = Plane { size: y.size, values: y.values.iter().map(|y| (y + 16.0) / 116.0).collect() };
        let smooth = y.across(&self.gaussian);
        let pair = |kernel: &Kernel| y.across(kernel).down(&self.gaussian).values.into_iter().zip(smooth.down(kernel).values);
        let length = |(dx, dy): (f32, f32)| (dx * dx + dy * dy).sqrt();
        pair(&self.edge).map(length).zip(pair(&self.point).map(length)).map(|(edge, point)| [edge, point])
    }
}

fn sum(kernel: &[f32]) -> f32 {
    kernel.iter().sum()
}

fn scaled(kernel: Kernel, total: f32) -> Kernel {
    kernel.into_iter().map(|weight| weight / total).collect()
}

/// Positive weights sum to 1, negative ones to −1.
fn balanced(kernel: Kernel) -> Kernel {
    let positive: f32 = kernel.iter().filter(|&&w| w > 0.0).sum();
    let negative: f32 = -kernel.iter().filter(|&&w| w < 0.0).sum::<f32>();
    kernel.into_iter().map(|weight| weight / if weight > 0.0 { positive } else { negative }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(size: [usize; 2], value: impl Fn(usize, usize) -> f32) -> Plane {
        Plane { size, values: (0..size[0] * size[1]).map(|i| value(i % size[0], i / size[0])).collect() }
    }

    #[test]
    fn flat_planes_pass_and_hold_no_features() {
        let flat = plane([5, 4], |_, _| 84.0);
        for seen in Smoothing::new(67.0).seen(&flat, &flat, &flat) {
            assert!(seen.values.iter().all(|v| (v - 84.0).abs() < 1e-3), "{:?}", seen.values);
        }
        assert!(Feature::new(67.0).strengths(&flat).all(|strengths| strengths.iter().all(|s| s.abs() < 1e-5)));
    }

    #[test]
    fn filters_are_alike_across_and_down() {
        let edge = plane([30, 30], |x, _| if x < 15 { 0.0 } else { 100.0 });
        let turned = plane([30, 30], |_, y| if y < 15 { 0.0 } else { 100.0 });
        let strengths = |plane: &Plane| Feature::new(67.0).strengths(plane).collect::<Vec<_>>();
        let (a, b) = (strengths(&edge), strengths(&turned));
        for (i, [edge, point]) in a.iter().enumerate() {
            let [turned_edge, turned_point] = b[(i % 30) * 30 + i / 30];
            assert!((edge - turned_edge).abs() < 1e-5 && (point - turned_point).abs() < 1e-5);
        }
        // A step of Y from 0 to 100 is one of 100/116, and the edge detector's weights of one sign sum to 1.
        assert!((a[14][0] - 100.0 / 116.0).abs() < 0.1, "{}", a[14][0]);
    }
}

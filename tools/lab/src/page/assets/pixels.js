// Pixels: from base64 in the page to what a canvas shows.

/** Every half-precision number as a float, by its 16 bits. */
const HALF = (() => {
  const table = new Float32Array(65536);
  for (let bits = 0; bits < 65536; bits++) {
    const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, fraction = bits & 1023;
    table[bits] =
      exponent === 31 ? (fraction ? NaN : sign * Infinity)
      : exponent ? sign * 2 ** (exponent - 15) * (1 + fraction / 1024)
      : sign * 2 ** -24 * fraction;
  }
  return table;
})();

function bytesOf(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes;
}

const payloads = new Map();

/** A payload of the page, decoded once by `decode`; null without a name. */
function payload(id, decode) {
  if (!id) return null;
  if (!payloads.has(id)) payloads.set(id, decode(bytesOf(document.getElementById(id).textContent)));
  return payloads.get(id);
}

const radiance = (id) => payload(id, (bytes) => Float32Array.from(new Uint16Array(bytes.buffer), (bits) => HALF[bits]));
const errors = (id) => payload(id, (bytes) => bytes);

const luminance = (r, g, b) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

/** The transfer function of sRGB in 4096 steps, to 8 bits. */
const SRGB = Uint8Array.from({length: 4097}, (_, i) => {
  const x = i / 4096;
  return Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
});
const encoded = (x) => SRGB[x > 0 ? (x < 1 ? Math.round(x * 4096) : 4096) : 0];

/** The curves of the pass `tonemap`: exposed colour in, linear display colour out, both in `c`. */
const CURVES = {
  linear() {},
  reinhard(c) {
    const scale = 1 / (1 + luminance(c[0], c[1], c[2]));
    for (let i = 0; i < 3; i++) c[i] *= scale;
  },
  aces(c) {
    multiply(c, 0.59719, 0.35458, 0.04823, 0.076, 0.90834, 0.01566, 0.0284, 0.13383, 0.83777);
    for (let i = 0; i < 3; i++) {
      const v = c[i];
      c[i] = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.432951) + 0.238081);
    }
    multiply(c, 1.60475, -0.53108, -0.07367, -0.10208, 1.10813, -0.00605, -0.00327, -0.07276, 1.07602);
  },
  agx(c) {
    multiply(c, 0.842479062, 0.0784336, 0.0792237451, 0.0423282422, 0.8784686365, 0.0791661275, 0.0423756549, 0.0784336, 0.879142974);
    for (let i = 0; i < 3; i++) {
      const stops = Math.min(Math.max(Math.log2(Math.max(c[i], 1e-10)), -12.47393), 4.026069);
      const x = (stops + 12.47393) / 16.5, x2 = x * x, x4 = x2 * x2;
      c[i] = 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
    }
    multiply(c, 1.196879005, -0.0980208811, -0.0990297441, -0.0528968518, 1.1519031299, -0.0989611768, -0.0529716355, -0.0980434501, 1.1510736726);
    for (let i = 0; i < 3; i++) c[i] = Math.max(c[i], 0) ** 2.2;
  },
};

/** c becomes M·c, M row by row. */
function multiply(c, a, b, d, e, f, g, h, i, j) {
  const [x, y, z] = c;
  c[0] = a * x + b * y + d * z;
  c[1] = e * x + f * y + g * z;
  c[2] = h * x + i * y + j * z;
}

/** Fills `out` (an ImageData) with exposed and tone-mapped radiance. Pixels that are not finite are magenta. */
function paintRadiance(out, pixels, stops, curve) {
  const scale = 2 ** stops, apply = CURVES[curve], c = new Float64Array(3), data = out.data;
  for (let i = 0, o = 0; i < pixels.length; i += 3, o += 4) {
    const r = pixels[i], g = pixels[i + 1], b = pixels[i + 2];
    data[o + 3] = 255;
    if (!Number.isFinite(r + g + b)) {
      data[o] = data[o + 2] = 255;
      data[o + 1] = 0;
      continue;
    }
    c[0] = Math.max(r, 0) * scale;
    c[1] = Math.max(g, 0) * scale;
    c[2] = Math.max(b, 0) * scale;
    apply(c);
    data[o] = encoded(c[0]);
    data[o + 1] = encoded(c[1]);
    data[o + 2] = encoded(c[2]);
  }
}

/** Relative difference of luminance at pixel i, with the epsilon of relMSE. */
function relativeDifference(pixels, reference, i) {
  const at = 3 * i, r = luminance(reference[at], reference[at + 1], reference[at + 2]);
  return (luminance(pixels[at], pixels[at + 1], pixels[at + 2]) - r) / (r + 0.01);
}

/** Blue too dark, red too bright; ±`range` fills the colour map. */
function paintDifference(out, pixels, reference, range, colors) {
  for (let i = 0; i < out.width * out.height; i++) {
    const place = 0.5 - relativeDifference(pixels, reference, i) / (2 * range);
    put(out.data, i, colors, Number.isFinite(place) ? Math.round(255 * Math.min(Math.max(place, 0), 1)) : 127);
  }
}

function paintErrors(out, values, colors) {
  for (let i = 0; i < values.length; i++) put(out.data, i, colors, values[i]);
}

function put(data, i, colors, code) {
  for (let c = 0; c < 3; c++) data[4 * i + c] = colors[3 * code + c];
  data[4 * i + 3] = 255;
}

/** Stops that bring the geometric mean of the lit pixels to middle grey, in steps of a quarter. */
function automaticExposure(pixels) {
  let sum = 0, count = 0;
  for (let i = 0; i < pixels.length; i += 3) {
    const y = luminance(pixels[i], pixels[i + 1], pixels[i + 2]);
    if (y > 0 && Number.isFinite(y)) {
      sum += Math.log2(y);
      count++;
    }
  }
  return count ? Math.round(4 * (Math.log2(0.18) - sum / count)) / 4 : 0;
}

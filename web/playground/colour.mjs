// colour.mjs: between linear colours of scenes and `#rrggbb`, which is sRGB.
const encode = c => (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055);
const decode = c => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);

export const toHex = colour =>
    `#${colour.map(c => Math.round(255 * encode(Math.min(Math.max(c, 0), 1))).toString(16).padStart(2, '0')).join('')}`;

export const fromHex = hex => [1, 3, 5].map(at => decode(parseInt(hex.slice(at, at + 2), 16) / 255));

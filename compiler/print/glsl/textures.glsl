/*
 * textures.glsl: texels of krs_cells, between them bilinear, and levels as fine as pixels; the same
 * formulas as in graph/texture.c.
 *
 * compiler/scene/tables.c writes the header of a texture, a texel, and the list of its levels behind it.
 */

KrsTexture krs_read_texture(uint header)
{
    uvec2 texel = krs_cell_texel(header);
    return KrsTexture(header + 1u, texel.x, texel.y & 3u, (texel.y & 4u) != 0u);
}

vec4 krs_texel(uint i, bool gray)
{
    uvec2 texel = krs_cell_texel(i);
    vec4 color = vec4(unpackHalf2x16(texel.x), unpackHalf2x16(texel.y));
    vec2 number = uintBitsToFloat(texel);
    return mix(color, number.xxxy, bvec4(gray));
}

// A place in the picture that stands there, in [0, 1].
vec2 krs_wrapped(vec2 uv, uint wrap)
{
    vec2 at = clamp(uv, -1073741824.0, 1073741824.0);
    vec2 mirrored = abs(at - 2.0 * floor(0.5 * at + 0.5));
    vec2 other = mix(clamp(at, 0.0, 1.0), mirrored, bvec2(wrap == 2u));
    return mix(other, fract(at), bvec2(wrap == 0u));
}

// Bilinear between four texels of a level, whose texel in the list is `found`.
vec4 krs_texture_level(vec2 place, uvec2 found, KrsTexture picture)
{
    bool round = picture.wrap == 0u;
    uvec2 size = uvec2(found.y & 0xffffu, found.y >> 16);
    vec2 at = place * vec2(size) - 0.5;
    vec2 whole = floor(at), part = at - whole, end = vec2(size) - 1.0;
    vec2 low = mix(max(whole, 0.0), end, bvec2(whole.x < 0.0 && round, whole.y < 0.0 && round));
    vec2 high = mix(min(whole + 1.0, end), vec2(0.0),
                    bvec2(whole.x >= end.x && round, whole.y >= end.y && round));
    uvec2 a = min(uvec2(low), size - 1u), b = min(uvec2(high), size - 1u);
    uint row = found.x + a.y * size.x, above = found.x + b.y * size.x;
    vec4 below = mix(krs_texel(row + a.x, picture.gray), krs_texel(row + b.x, picture.gray), part.x);
    vec4 over = mix(krs_texel(above + a.x, picture.gray), krs_texel(above + b.x, picture.gray), part.x);
    return mix(below, over, part.y);
}

vec4 krs_texture_sharp(vec2 uv, KrsTexture picture)
{
    return krs_texture_level(krs_wrapped(uv, picture.wrap), krs_cell_texel(picture.list), picture);
}

// Tap i of some, whose places advance along a pixel.  `found` are two levels; of the taps as large a share
// reads the second as it has.  A single tap mixes both, and is two.
vec4 krs_texture_tap(float i, float taps, vec2 middle, vec2 advance, uvec4 found, float share,
                     KrsTexture picture)
{
    bool single = taps < 1.5;
    bool coarse = single ? i > 0.0 : floor((i + 1.0) * share + 0.5) > floor(i * share + 0.5);
    float weight = single ? (coarse ? share : 1.0 - share) : 1.0 / taps;
    vec2 at = middle + (single ? 0.0 : i + 0.5 - 0.5 * taps) * advance;
    uvec2 own = uvec2(coarse ? found.z : found.x, coarse ? found.w : found.y);
    vec4 color = krs_texture_level(krs_wrapped(at, picture.wrap), own, picture);
    return (i < max(taps, 2.0) ? weight : 0.0) * color;
}

// For a pixel: its long side in u and v, how many taps that has, and the width of each in texels.  There is
// no loop over taps, in which lavapipe would be slow.
vec4 krs_texture(vec2 uv, vec4 pixel, KrsTexture picture)
{
    float most = float(picture.levels - 1u);
    float width = mix(65536.0, max(pixel.w, 1.0), pixel.w < 65536.0); // also where it is no number
    float level = min(log2(width), most), fine = floor(level), share = level - fine;
    uvec4 found = uvec4(krs_cell_texel(picture.list + uint(fine)),
                        krs_cell_texel(picture.list + uint(min(fine + 1.0, most))));
    float taps = pixel.z > 1.0 ? min(pixel.z, 3.0) : 1.0;
    vec2 advance = taps > 1.0 ? pixel.xy / taps : vec2(0.0);
    return krs_texture_tap(0.0, taps, uv, advance, found, share, picture) +
           krs_texture_tap(1.0, taps, uv, advance, found, share, picture) +
           krs_texture_tap(2.0, taps, uv, advance, found, share, picture);
}

/*
 * texture.h: textures: pictures that expressions read, by OP_texture and OP_texture_gray.
 *
 * A texture is a pyramid of levels: level 0 is the picture, and each further one has half the width
 * and height of the one before, down to a single texel.  A texel of a level is the mean of what it
 * covers.  Between the middles of texels values are bilinear.  Where a pixel is wider than a texel,
 * the two levels whose texels are about as wide are mixed.  A pixel that is longer than wide is a mean
 * of several places along its long side, the taps, each as wide as the pixel is across.
 *
 * Texels are stored as shaders read them, in 64 bits.  Those of gray textures are two floats, the
 * gray and the alpha, since heights need all digits.  Those of colours are four halves: red, green,
 * blue and alpha.  Colours are linear, and multiplied by alpha, so that means and mixtures are right.
 *
 * u goes from 0 at the left edge to 1 at the right one, v from 0 at the bottom to 1 at the top.
 */
#ifndef KRS_TEXTURE_H
#define KRS_TEXTURE_H

#include "compiler/graph/graph.h"
#include "compiler/graph/range.h"

/* The content outside of the picture: the picture again, its edge, or its mirror image. */
typedef enum TextureWrap { WRAP_REPEAT, WRAP_CLAMP, WRAP_MIRROR, WRAP_COUNT } TextureWrap;

typedef uint32_t TexelBits[2];

/* Red, green, blue and alpha. */
enum { TEXTURE_CHANNELS = 4 };
enum { MAX_TEXTURE_LEVELS = 16, MAX_TEXTURE_SIDE = 1 << 15, MAX_TEXELS = 1 << 24 };

/* The components of what a node of OP_texture knows of the pixel: its long side, in u and v; how
   many taps it has; and the width of each, in texels of level 0. */
enum { TEXTURE_LONG_U, TEXTURE_LONG_V, TEXTURE_TAPS, TEXTURE_WIDTH };
enum { MAX_TEXTURE_TAPS = 3 };

/* The texels of krs_cells in the header of a texture for shaders. */
enum { TEXTURE_HEADER = 1 + MAX_TEXTURE_LEVELS };

typedef struct TextureLevel {
    uint32_t width, height;
    size_t   first; /* its first texel; rows go from the bottom upwards */
} TextureLevel;

typedef struct Texture {
    const char  *name; /* of the file */
    TextureWrap  wrap;
    bool         gray;
    uint32_t     level_count;
    TextureLevel levels[MAX_TEXTURE_LEVELS];
    TexelBits   *texels; /* of all levels */
    size_t       texel_count;
    /* The range of the values of each channel of level 0, and the largest difference of texels side
       by side and one above the other. */
    Range  range[TEXTURE_CHANNELS];
    double across[TEXTURE_CHANNELS], up[TEXTURE_CHANNELS];
    /* The largest slope, for steps of a texel: of the first channel, and of all four together. */
    double slope_of_first, slope_of_all;
} Texture;

/* The textures of a scene, which its graphs share. */
typedef struct Textures {
    struct {
        Texture *items;
        size_t   count, capacity;
    } list;
} Textures;

/* Makes the levels of a picture and what is known of them.  `samples` has four floats for each pixel,
   two if `gray`; its rows go from the top downwards.  Sides are at most MAX_TEXTURE_SIDE, and both
   together at most MAX_TEXELS. */
Texture texture_new(const float *samples, uint32_t width, uint32_t height, bool gray,
                    TextureWrap wrap, Arena *arena, Arena *scratch);

/* Returns the texture that a node of OP_texture or OP_texture_gray reads. */
const Texture *texture_of(const Graph *graph, const Expr *e);
/* Returns the value at a place, for pixels of a width in texels of level 0. */
NodeValue texture_value(const Texture *texture, const double uv[2], double width);
/* Returns the same for a pixel with a long side. */
NodeValue texture_mean(const Texture *texture, const double uv[2], const double pixel[4]);
/* Adds a node of a texture: a VEC4, or the first channel of a gray texture as a FLOAT. */
Node               graph_texture(Graph *graph, Op op, uint32_t texture, Node uv, Node pixel);
static inline bool is_texture(Op op) { return op == OP_texture || op == OP_texture_gray; }

#endif

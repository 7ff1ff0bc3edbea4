/*
 * texture.c: `texture`, what its value does, and `footprint`.
 */
#include "compiler/eval/data/from_files.h"

#include <string.h>

#include "compiler/graph/build.h"
#include "compiler/graph/texture.h"
#include "compiler/image/image.h"

/* ---- reading ---- */

static const char *const wrap_names[WRAP_COUNT] = {
    [WRAP_REPEAT] = "repeat", [WRAP_CLAMP] = "clamp", [WRAP_MIRROR] = "mirror"};
static const char *const space_names[SPACE_COUNT] = {
    [SPACE_OF_FILE] = "file", [SPACE_SRGB] = "srgb", [SPACE_LINEAR] = "linear"};
static const Choices wraps  = {.noun    = "wrap",
                               .wanted  = "what is outside of the picture, a string",
                               .unknown = "unknown wrap",
                               .more    = "",
                               .items   = wrap_names,
                               .count   = WRAP_COUNT};
static const Choices spaces = {.noun    = "space",
                               .wanted  = "the space of the picture's numbers, a string",
                               .unknown = "unknown space",
                               .more    = "; a PNG file is sRGB unless it says otherwise",
                               .items   = space_names,
                               .count   = SPACE_COUNT};

static bool same_key(const TextureKey *a, const TextureKey *b)
{
    return a->wrap == b->wrap && a->space == b->space && strcmp(a->path, b->path) == 0;
}

static bool find_texture(const Elaboration *e, const TextureKey *key, uint32_t *number)
{
    for (size_t i = 0; i < e->textures.count; i++)
        if (same_key(&e->textures.items[i], key)) {
            *number = (uint32_t)i;
            return true;
        }
    return false;
}

/* Copies of a picture that are only needed while it is read are freed. */
static bool make_texture(Elaboration *e, const Argument *file, const FileBytes *bytes,
                         const TextureKey *key)
{
    Image image = {.arena      = e->scratch,
                   .space      = (ImageSpace)key->space,
                   .max_side   = MAX_TEXTURE_SIDE,
                   .max_pixels = MAX_TEXELS};
    bool  read  = image_read(&image, bytes->bytes, bytes->length);
    if (read) {
        Textures *all     = e->graph->textures;
        Texture   texture = texture_new(image.samples, image.width, image.height, image.gray,
                                        (TextureWrap)key->wrap, e->textures.arena, e->scratch);
        texture.name      = arena_copy_text(e->textures.arena, key->path, strlen(key->path));
        array_push(e->textures.arena, &all->list, texture);
        array_push(e->arena, &e->textures, *key);
    } else
        refuse_picture(e, file->syntax, bytes->path, image.fault);
    arena_free(e->scratch);
    return read;
}

Value builtin_texture(Elaboration *e, Call *call)
{
    const Argument *file = &call->arguments[0];
    FileBytes       bytes;
    TextureKey      key = {0};
    uint32_t        number;
    if (file->value.type != VALUE_STRING) {
        type_error(e, file->syntax, file->value, "the name of a file");
        return value_error();
    }
    if (!want_name(e, &call->arguments[1], &wraps, &key.wrap) ||
        !want_name(e, &call->arguments[2], &spaces, &key.space) ||
        !read_beside(e, file, file->value.string, &bytes))
        return value_error();
    key.path = bytes.path;
    if (!e->graph->textures)
        e->graph->textures = arena_new(e->textures.arena, Textures);
    if (!find_texture(e, &key, &number)) {
        number = (uint32_t)e->textures.count;
        if (!make_texture(e, file, &bytes, &key))
            return value_error();
    }
    return (Value){.type = VALUE_TEXTURE, .texture = number};
}

/* ---- the footprint ---- */

/* Tells how far each component of a node changes within a pixel. */
static Node footprint_of(Graph *g, Node node)
{
    const GraphType type = (GraphType)g->items[node].type;
    Node            parts[4];
    static const Op build[] = {[TYPE_VEC2] = OP_vec2, [TYPE_VEC3] = OP_vec3, [TYPE_VEC4] = OP_vec4};
    for (uint32_t i = 0; i < (uint32_t)type; i++) {
        Node part = graph_component(g, node, i);
        parts[i]  = graph_op1(g, OP_footprint, part);
    }
    return type == TYPE_FLOAT ? parts[0] : graph_op(g, build[type], parts);
}

Value builtin_footprint(Elaboration *e, Call *call)
{
    Node node = want_numeric(e, call, 0);
    if (node == NODE_NONE)
        return value_error();
    e->graph->here = call->syntax->span;
    return value_of_node(e, footprint_of(e->graph, node));
}

/* ---- samples ---- */

/* Returns what a texture needs to know of a pixel (graph/texture.h).  Its taps need be no narrower
   than a texel. */
static Node pixel_on_texture(Graph *g, const Texture *texture, Node uv)
{
    const double sides[2] = {texture->levels[0].width, texture->levels[0].height};
    Node         size     = graph_constant(g, TYPE_VEC2, sides);
    Node         axes     = graph_op1(g, OP_footprint_axes, mul(g, uv, size));
    Node         across = graph_component(g, axes, 0), up = graph_component(g, axes, 1);
    Node         along  = graph_op2(g, OP_vec2, across, up);
    Node         length = graph_op1(g, OP_length, along), width = graph_component(g, axes, 2);
    Node         wanted = graph_op1(g, OP_ceil, over(g, length, at_least(g, width, 1)));
    Node         most   = graph_number(g, MAX_TEXTURE_TAPS);
    Node         taps   = at_least(g, graph_op2(g, OP_min, wanted, most), 1);
    Node         wide   = graph_op2(g, OP_max, width, over(g, length, taps));
    Node         place  = over(g, along, size);
    Node         u = graph_component(g, place, 0), v = graph_component(g, place, 1);
    return graph_op4(g, OP_vec4, u, v, taps, wide);
}

/* Returns an argument that is a number, or both as a vector; NODE_NONE: reported. */
static Node want_coordinate(Elaboration *e, const Argument *argument, uint32_t size,
                            const char *wanted)
{
    if (value_size(e, argument->value) == size)
        return value_node(e, argument->value);
    type_error(e, argument->syntax, argument->value, wanted);
    return NODE_NONE;
}

/* Returns the place that the arguments `u v` are; NODE_NONE: reported. */
static Node want_place(Elaboration *e, const Call *call)
{
    const Argument *u = &call->arguments[0], *v = &call->arguments[1];
    if (!v->syntax)
        return want_coordinate(e, u, 2, "two numbers, u and v, or a vector of both");
    Node across    = want_coordinate(e, u, 1, "a number, which `u` is");
    Node up        = want_coordinate(e, v, 1, "a number, which `v` is");
    e->graph->here = call->syntax->span;
    return across == NODE_NONE || up == NODE_NONE ? NODE_NONE
                                                  : graph_op2(e->graph, OP_vec2, across, up);
}

/* Reads a texture at compile time, if the place is known. */
static Value known_sample(Elaboration *e, const Texture *texture, Node uv, bool alpha)
{
    double place[2];
    graph_known_components(e->graph, uv, 2, place);
    NodeValue value = texture_value(texture, place, 0);
    return alpha ? value_number(value.v[3]) : value_vector(e, value.v, 3);
}

static Value sample(Elaboration *e, uint32_t number, const Call *call, bool alpha)
{
    Graph         *g       = e->graph;
    const Texture *texture = &g->textures->list.items[number];
    Node           uv      = want_place(e, call);
    if (uv == NODE_NONE)
        return value_error();
    g->here = call->syntax->span;
    if (graph_known_finite(g, uv))
        return known_sample(e, texture, uv, alpha);
    Node pixel = pixel_on_texture(g, texture, uv);
    if (texture->gray && !alpha) {
        Node gray = graph_texture(g, OP_texture_gray, number, uv, pixel);
        return value_of_node(e, graph_op1(g, OP_splat3, gray));
    }
    Node all = graph_texture(g, OP_texture, number, uv, pixel);
    if (alpha)
        return value_of_node(e, graph_component(g, all, 3));
    Node red = graph_component(g, all, 0), green = graph_component(g, all, 1);
    Node blue = graph_component(g, all, 2);
    return value_of_node(e, graph_op3(g, OP_vec3, red, green, blue));
}

static Value call_sample(Elaboration *e, const Environment *env, const Syntax *syntax,
                         const char *name, uint32_t number, bool alpha)
{
    Call call;
    if (!bind_arguments(e, env, syntax, 1, name, "u v=", &call))
        return value_error();
    return sample(e, number, &call, alpha);
}

Value call_texture(Elaboration *e, const Environment *env, const Syntax *syntax, uint32_t number)
{
    return call_sample(e, env, syntax, "texture", number, false);
}

static Value size_of_texture(Elaboration *e, uint32_t number)
{
    const TextureLevel *level   = &e->graph->textures->list.items[number].levels[0];
    const double        size[2] = {level->width, level->height};
    return value_vector(e, size, 2);
}

Value texture_method(Elaboration *e, const Environment *env, const Syntax *syntax, uint32_t number)
{
    static const char *const names[] = {"alpha", "size"};
    if (strcmp(syntax->name, "alpha") == 0)
        return call_sample(e, env, syntax, "alpha", number, true);
    if (strcmp(syntax->name, "size") == 0 && syntax->count == 1)
        return size_of_texture(e, number);
    Diag *diag  = diag_add(e->diags, DIAG_UNKNOWN_METHOD, syntax->name_span,
                           "a texture has no method `%s`", syntax->name);
    diag->label = "unknown method";
    note_names(e, diag, "its methods", names, 2);
    return value_error();
}

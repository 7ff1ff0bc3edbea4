/*
 * sky.c: the sky of a scene: three colours, a picture of all directions, or daylight.
 */
#include "compiler/eval/view/view.h"

#include <math.h>
#include <string.h>

#include "compiler/image/image.h"

/* The largest picture: 128 MiB on the device, and a third more to choose directions by. */
enum { MAX_SKY_SIDE = 1 << 13, MAX_SKY_TEXELS = 1 << 23 };

/* Makes a map of red, green and blue; negative numbers become 0. */
static const KrsSkyMap *make_map(Elaboration *e, const Image *image)
{
    const uint32_t channels = image_channels(image);
    const size_t   count    = image_pixels(image);
    float(*texels)[3]       = arena_alloc(e->textures.arena, count, sizeof *texels);
    KrsSkyMap *map          = arena_new(e->textures.arena, KrsSkyMap);
    for (size_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < 3; k++)
            texels[i][k] = fmaxf(image->samples[i * channels + (image->gray ? 0 : k)], 0);
    *map         = (KrsSkyMap){image->width, image->height, 0, (const float(*)[3])texels};
    map->version = sky_map_version(map);
    return map;
}

static const KrsSkyMap *read_map(Elaboration *e, const Syntax *syntax, const char *name)
{
    const Argument file = {.syntax = syntax};
    FileBytes      bytes;
    Image image = {.arena = e->scratch, .max_side = MAX_SKY_SIDE, .max_pixels = MAX_SKY_TEXELS};
    const KrsSkyMap *map = NULL;
    if (!read_beside(e, &file, name, &bytes))
        return NULL;
    if (image_read(&image, bytes.bytes, bytes.length))
        map = make_map(e, &image);
    else
        refuse_picture(e, syntax, bytes.path, image.fault);
    arena_free(e->scratch);
    return map;
}

/* Returns the picture of the sky; NULL: there is none, or it is reported. */
static const KrsSkyMap *sky_image(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    const Syntax *image = find_property(syntax, "image");
    Value         value = image ? evaluate(e, env, image) : (Value){.type = VALUE_ERROR};
    if (value.type == VALUE_STRING)
        return read_map(e, image, value.string);
    if (value.type != VALUE_ERROR)
        type_error(e, image, value, "the name of a file");
    return NULL;
}

/* ---- what does not go together ---- */

/* Refuses properties of another kind of sky than that of `owner`. */
static void refuse_others(Elaboration *e, const Syntax *syntax, const char *owner,
                          const char *const *others, size_t count)
{
    const bool article = owner[0] == 'i';
    for (size_t i = 0; i < count; i++) {
        const Syntax *given = find_property(syntax, others[i]);
        if (given)
            diag_add(e->diags, DIAG_BAD_VALUE, given->span, "a sky with %s `%s` has no `%s`",
                     article ? "an" : "a", owner, others[i]);
    }
}

static void refuse_idle(Elaboration *e, const Syntax *syntax)
{
    static const char *const colours[] = {"zenith", "horizon", "ground", "turbidity"};
    static const char *const fixed[]   = {"zenith", "horizon"};
    const Syntax            *turned    = find_property(syntax, "rotation");
    if (find_property(syntax, "image"))
        refuse_others(e, syntax, "image", colours, sizeof colours / sizeof *colours);
    else if (find_property(syntax, "turbidity"))
        refuse_others(e, syntax, "turbidity", fixed, sizeof fixed / sizeof *fixed);
    if (!find_property(syntax, "image") && turned) {
        Diag *diag = diag_add(e->diags, DIAG_BAD_VALUE, turned->span,
                              "only a sky with an `image` has a `rotation`");
        diag->help = "for example `sky { image: \"harbour.exr\", rotation: 30deg }`";
    }
}

/* ---- daylight ---- */

static const char daylight_help[] =
    "for example `light day { direction: [1, 1, 1], intensity: 3 }` with `sky { sun: day, "
    "turbidity: 2.5 }`";

static void check_turbidity(Elaboration *e, const Syntax *given, Node turbidity)
{
    if (node_range(e->builder, turbidity, 0).low >= 1)
        return;
    Diag *diag = diag_add(e->diags, DIAG_BAD_VALUE, given->span, "`turbidity` must be at least 1");
    diag->help = "1 is pure air, 2.5 a clear day, 6 is hazy";
}

void complete_sky(Elaboration *e)
{
    SceneSky *sky = &e->scene->sky;
    if (!sky->daylight)
        return;
    for (size_t i = 0; sky->sun && i < e->scene->lights.count; i++) {
        const SceneLight *light = &e->scene->lights.items[i];
        if (!light->name || strcmp(light->name, sky->sun) != 0)
            continue;
        sky->light = i;
        if (light->positional) {
            Diag *diag = diag_add(e->diags, DIAG_BAD_VALUE, sky->sun_span,
                                  "the sun of a daylight sky must have a `direction`");
            diag->help = daylight_help;
        }
        return;
    }
    sky->daylight = false;
    if (sky->sun && e->diags->errors == 0)
        diag_add(e->diags, DIAG_BAD_VALUE, sky->sun_span, "`%s` is no light", sky->sun);
}

/* ---- all skies ---- */

/* Returns a colour of the sky, times its intensity; of daylight `ground` is an albedo. */
static Node sky_colour(Elaboration *e, const Environment *env, const Syntax *syntax,
                       const char *name, const double otherwise[3])
{
    Node color = vector_property(e, env, syntax, name, otherwise);
    return find_property(syntax, "intensity") && !e->scene->sky.daylight
               ? graph_op2(e->graph, OP_scale, color, e->scene->sky.intensity)
               : color;
}

static Node sky_intensity(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    const Syntax *given     = find_property(syntax, "intensity");
    Node          intensity = number_property(e, env, syntax, "intensity", 1);
    if (given && node_range(e->builder, intensity, 0).low < 0)
        diag_add(e->diags, DIAG_BAD_VALUE, given->span,
                 "the intensity of the sky must not be negative");
    return intensity;
}

void elaborate_sky(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    static const double zenith[3]  = {0.17, 0.26, 0.42};
    static const double horizon[3] = {0.56, 0.6, 0.66};
    static const double ground[3]  = {0.17, 0.165, 0.16};
    SceneSky           *sky        = &e->scene->sky;
    const Syntax       *turned     = find_property(syntax, "rotation");
    const Syntax       *hazy       = find_property(syntax, "turbidity");
    const Syntax       *sun        = find_property(syntax, "sun");
    sky->daylight                  = hazy != NULL;
    sky->intensity                 = sky_intensity(e, env, syntax);
    sky->rotation                  = number_property(e, env, syntax, "rotation", 0);
    sky->turbidity                 = number_property(e, env, syntax, "turbidity", 1);
    sky->zenith                    = sky_colour(e, env, syntax, "zenith", zenith);
    sky->horizon                   = sky_colour(e, env, syntax, "horizon", horizon);
    sky->ground                    = sky_colour(e, env, syntax, "ground", ground);
    sky->map                       = sky_image(e, env, syntax);
    refuse_idle(e, syntax);
    if (turned)
        warn_of_revolutions(e, turned, evaluate(e, env, turned));
    if (hazy)
        check_turbidity(e, hazy, sky->turbidity);
    /* `sun:` names the light that is the sun; every light is in the sky anyway. */
    if (sun && sun->kind != SYNTAX_NAME)
        type_error(e, sun, evaluate(e, env, sun), "the name of a light");
    sky->sun      = sun && sun->kind == SYNTAX_NAME ? sun->name : NULL;
    sky->sun_span = sun ? sun->span : syntax->span;
    if (hazy && !sun) {
        Diag *diag = diag_add(e->diags, DIAG_MISSING_ARGUMENT, hazy->span,
                              "a daylight sky needs a `sun`, the name of a light");
        diag->help = daylight_help;
    }
}

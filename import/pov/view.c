/*
 * view.c: camera, lights, background and settings of POV-Ray.
 */
#include <math.h>
#include <string.h>

#include "import/pov/reader.h"
#include "compiler/base/vec.h"

static const double DEGREE = 3.14159265358979323846 / 180;

/* ---- reading ---- */

/* Reads a word and the vector behind it; *taken: it is that word. */
static bool vector_of(PovReader *reader, const char *name, double v[3], bool *taken)
{
    if (*taken || !word_accept(&reader->words, name))
        return true;
    *taken = true;
    return pov_vector(reader, v);
}

/* Tells how far away the picture is that is `right` wide and `up` high. */
static double distance_of_picture(const PovView *view)
{
    return view->angle > 0 ? length3(view->right) / 2 / tan(view->angle * DEGREE / 2)
                           : length3(view->direction);
}

/* Widens the view: `orthographic` behind the rest of a camera shows as much as that camera does at
   the distance of `look_at`. */
static void widen(PovView *view)
{
    double away        = distance_of_picture(view);
    view->orthographic = true;
    if (!view->looks || !(away > 0))
        return;
    double factor = distance3(view->location, view->look_at) / away;
    for (int i = 0; i < 3; i++) {
        view->right[i] *= factor;
        view->up[i] *= factor;
    }
    view->widened = true;
}

/* A camera is moved as it is at this word: what stands behind it is where it says. */
static void move_camera(PovReader *reader, PovView *view, const Transform *transform)
{
    Transform rotation = *transform;
    memset(rotation.shift, 0, sizeof rotation.shift);
    transform_apply(transform, view->location, view->location);
    transform_apply(transform, view->look_at, view->look_at);
    transform_apply(&rotation, view->direction, view->direction);
    transform_apply(&rotation, view->right, view->right);
    transform_apply(&rotation, view->up, view->up);
    if (view->looks)
        transform_apply(&rotation, view->sky, view->sky);
    double slack = 1e-6 * length3(view->right) * length3(view->up);
    if (fabs(dot3(view->right, view->up)) > slack)
        import_note(reader->import, reader->words.word.line, "the camera is not sheared");
}

/* Reads `angle` from side to side, and of spherical cameras another one from top to bottom. */
static bool camera_angle(PovReader *reader, PovView *view)
{
    view->angle_up = 0;
    if (!pov_number(reader, &view->angle))
        return false;
    return !view->spherical || !word_accept(&reader->words, ",") ||
           pov_number(reader, &view->angle_up);
}

static bool camera_kind(PovReader *reader, PovView *view, bool *taken)
{
    unsigned line = reader->words.word.line;
    *taken        = true;
    if (word_accept(&reader->words, "perspective"))
        return true;
    if (word_accept(&reader->words, "orthographic")) {
        widen(view);
        return true;
    }
    *taken = word_accept(&reader->words, "spherical");
    if (*taken) {
        view->spherical      = true;
        view->spherical_line = line;
    }
    return true;
}

/* Reads what is sharp. */
static bool camera_lens(PovReader *reader, PovView *view, bool *taken)
{
    double nothing;
    bool   focal = word_is(&reader->words, "focal_point");
    *taken       = false;
    if (!vector_of(reader, "focal_point", view->focal_point, taken))
        return false;
    view->has_focal_point = view->has_focal_point || focal;
    if (*taken)
        return true;
    *taken = true;
    if (word_accept(&reader->words, "aperture"))
        return pov_number(reader, &view->aperture);
    if (word_accept(&reader->words, "blur_samples")) {
        double least; /* stands before a comma */
        if (!pov_number(reader, &view->blur_samples))
            return false;
        return !word_accept(&reader->words, ",") || pov_number(reader, &least);
    }
    if (word_accept(&reader->words, "confidence") || word_accept(&reader->words, "variance"))
        return pov_number(reader, &nothing);
    *taken = false;
    return true;
}

static bool camera_word(PovReader *reader, PovView *view)
{
    bool      taken = false, moved = false;
    Transform transform = transform_identity();
    if (!pov_release(reader) || !pov_transform(reader, &transform, &moved))
        return false;
    if (moved) {
        move_camera(reader, view, &transform);
        return true;
    }
    PovCell *own = pov_take(reader, POV_CAMERA);
    if (own) {
        *view = *own->view;
        return true;
    }
    if (word_accept(&reader->words, ";") || word_accept(&reader->words, ","))
        return true;
    bool direction = word_is(&reader->words, "direction");
    bool looks     = word_is(&reader->words, "look_at");
    bool location  = word_is(&reader->words, "location");
    if (!vector_of(reader, "location", view->location, &taken) ||
        !vector_of(reader, "look_at", view->look_at, &taken) ||
        !vector_of(reader, "sky", view->sky, &taken) ||
        !vector_of(reader, "direction", view->direction, &taken) ||
        !vector_of(reader, "right", view->right, &taken) ||
        !vector_of(reader, "up", view->up, &taken))
        return false;
    view->has_direction = view->has_direction || direction;
    view->looks         = view->looks || looks;
    if (location)
        memcpy(view->said_location, view->location, sizeof view->location);
    if (!taken && word_accept(&reader->words, "angle"))
        return camera_angle(reader, view);
    if (taken || !camera_kind(reader, view, &taken) || taken ||
        !camera_lens(reader, view, &taken) || taken)
        return reader->import->refusal.length == 0;
    return pov_leave_out(reader, "of the camera is");
}

/* Makes a spherical camera of 360 by 180 degrees a panorama; others are refused. */
static void settle_sphere(PovReader *reader, PovView *view)
{
    double across = view->angle > 0 ? view->angle : 360;
    double upward = view->angle_up > 0 ? view->angle_up : across / 2;
    if (!view->spherical || (across == 360 && upward == 180))
        return;
    view->spherical = false;
    import_note(
        reader->import, view->spherical_line,
        "`spherical` of the camera is left out: it is of %g by %g degrees, and panoramas are "
        "of 360 by 180",
        across, upward);
}

static PovView usual_camera(unsigned line)
{
    return (PovView){.has_camera = true,
                     .sky        = {0, 1, 0},
                     .look_at    = {0, 0, 1},
                     .direction  = {0, 0, 1},
                     .right      = {4 / 3.0, 0, 0},
                     .up         = {0, 1, 0},
                     .line       = line};
}

bool pov_camera(PovReader *reader, PovView *view)
{
    unsigned line = reader->words.word.line;
    *view         = usual_camera(line);
    words_advance(&reader->words);
    if (!word_expect(&reader->words, "{"))
        return false;
    while (!word_is(&reader->words, "}"))
        if (!camera_word(reader, view))
            return false;
    if (view->orthographic && view->angle > 0 && !view->widened)
        widen(view);
    if (!view->looks) {
        memcpy(view->sky, view->up, sizeof view->sky);
        add_scaled3(view->look_at, view->location, 1, view->direction);
    }
    settle_sphere(reader, view);
    if (view->angle >= 180 && !view->spherical) {
        import_note(reader->import, line, "an angle of %g degrees is one of 120 here", view->angle);
        view->angle = 120;
    }
    if (length3(view->direction) == 0 || length3(view->right) == 0 || length3(view->up) == 0 ||
        distance3(view->location, view->look_at) == 0 || !(view->angle >= 0) ||
        (view->angle >= 180 && !view->spherical))
        return import_refuse(reader->import, line, "the camera shows nothing");
    double across[3];
    cross3(view->up, view->direction, across);
    view->mirrored = dot3(across, view->right) <= 0; /* as POV-Ray decides it */
    return word_expect(&reader->words, "}");
}

static bool light_word(PovReader *reader, PovLight *light, Transform *transform)
{
    bool taken = false;
    if (!pov_release(reader))
        return false;
    if (!pov_transform(reader, transform, &taken) || taken)
        return taken;
    if (word_accept(&reader->words, ";") || word_accept(&reader->words, ","))
        return true;
    if (word_accept(&reader->words, "spotlight"))
        return light->spot = true;
    if (word_accept(&reader->words, "radius"))
        return pov_number(reader, &light->full);
    if (word_accept(&reader->words, "falloff"))
        return pov_number(reader, &light->falloff);
    if (word_accept(&reader->words, "parallel"))
        return light->parallel = true;
    if (word_accept(&reader->words, "shadowless"))
        return light->shadowless = true;
    if (!vector_of(reader, "point_at", light->target, &taken) || taken)
        return taken;
    if (pov_color_follows(reader) && !pov_value_follows(reader))
        return pov_color(reader, light->color);
    return pov_leave_out(reader, "of a light is");
}

bool pov_light(PovReader *reader, PovLight *light)
{
    Transform transform = transform_identity();
    *light              = (PovLight){
                     .line = reader->words.word.line, .color = {1, 1, 1}, .full = 30, .falloff = 45};
    words_advance(&reader->words);
    if (!word_expect(&reader->words, "{"))
        return false;
    PovCell *own = pov_take(reader, POV_LIGHT);
    if (own) {
        *light = *own->light;
    } else {
        if (!pov_vector(reader, light->position))
            return false;
        word_accept(&reader->words, ",");
        if (pov_color_follows(reader) && !pov_color(reader, light->color))
            return false;
    }
    while (!word_is(&reader->words, "}"))
        if (!light_word(reader, light, &transform))
            return false;
    transform_apply(&transform, light->position, light->position);
    transform_apply(&transform, light->target, light->target);
    if (!light->parallel)
        import_note(reader->import, light->line,
                    "lights grow weaker with distance; they are as bright as in POV-Ray where the "
                    "camera looks at");
    return word_expect(&reader->words, "}");
}

static void set_background(PovReader *reader, unsigned line, const double *color)
{
    reader->background_line = line;
    reader->has_background  = true;
    memcpy(reader->background, color, sizeof reader->background);
    if (fmax(color[0], fmax(color[1], color[2])) > 0)
        import_note(reader->import, line, "the background lights the scene");
}

bool pov_background(PovReader *reader)
{
    unsigned line = reader->words.word.line;
    words_advance(&reader->words);
    double color[5];
    if (!word_expect(&reader->words, "{") || !pov_color(reader, color) ||
        !word_expect(&reader->words, "}"))
        return false;
    set_background(reader, line, color);
    return true;
}

bool pov_sky_look(PovReader *reader, PovLook *sky)
{
    *sky = pov_usual_look();
    words_advance(&reader->words);
    if (!word_expect(&reader->words, "{"))
        return false;
    while (!word_is(&reader->words, "}")) {
        bool      taken   = false;
        Transform nowhere = transform_identity();
        PovCell  *own     = pov_take(reader, POV_SKY);
        if (own) {
            *sky = own->look;
            continue;
        }
        PovLook layer = pov_usual_look();
        if (!pov_look(reader, &layer, &taken) ||
            (!taken && !pov_transform(reader, &nowhere, &taken)) ||
            (!taken && !pov_leave_out(reader, "of a `sky_sphere` is")))
            return false;
        if (layer.colored)
            pov_add_layer(sky, &layer);
    }
    return word_expect(&reader->words, "}");
}

bool pov_sky_sphere(PovReader *reader)
{
    PovLook  sky;
    unsigned line = reader->words.word.line;
    if (!pov_sky_look(reader, &sky))
        return false;
    if (sky.colored) {
        import_note(reader->import, line, "`sky_sphere` is one colour, its mean");
        set_background(reader, line, sky.color);
    }
    return true;
}

/* The words that change how POV-Ray computes, and not what. */
static const char *const technical[] = {"max_trace_level", "adc_bailout",     "max_intersections",
                                        "noise_generator", "number_of_waves", "irid_wavelength",
                                        "charset",         "mm_per_unit",     "hf_gray_16"};

static bool setting(PovReader *reader)
{
    double color[5];
    if (!pov_release(reader))
        return false;
    if (word_accept(&reader->words, "assumed_gamma")) {
        reader->found_gamma = 0;
        return word_accept(&reader->words, "srgb") || pov_number(reader, &reader->found_gamma);
    }
    if (!word_accept(&reader->words, "ambient_light"))
        return pov_leave_out(
            reader, word_among(&reader->words, technical) ? NULL : "of `global_settings` is");
    if (!pov_color(reader, color))
        return false;
    memcpy(reader->ambient, color, sizeof reader->ambient);
    return true;
}

bool pov_settings(PovReader *reader)
{
    words_advance(&reader->words);
    if (!word_expect(&reader->words, "{"))
        return false;
    while (!word_is(&reader->words, "}"))
        if (!setting(reader))
            return false;
    return word_expect(&reader->words, "}");
}

/* ---- writing ---- */

static const char *point_text(PovReader *reader, const double q[3])
{
    double p[3];
    if (reader->view.mirrored)
        memcpy(p, q, sizeof p);
    else
        pov_point(q, p);
    return import_vector_text(reader->import, p, 3);
}

/* Writes the lens.  With n samples POV-Ray's lens is a pattern of points, whose mean distance from the middle
   is about that of a disc with a quarter of the aperture as its radius. */
static void write_lens(PovReader *reader)
{
    const PovView *view  = &reader->view;
    double         focus = view->has_focal_point ? distance3(view->said_location, view->focal_point)
                                                 : distance_of_picture(view);
    if (!(view->aperture > 0 && view->blur_samples > 0 && focus > 0) || view->spherical ||
        view->orthographic)
        return;
    text_format(&reader->import->scene, "    aperture: %s,\n    focus: %s,\n",
                import_number_text(reader->import, view->aperture / 4),
                import_number_text(reader->import, focus));
}

/* Returns the target.  Rays end 10,000 times as far as the target of the camera, if planes are
   endless.  Where these are high above the eye, as skies are, the target is farther along the same
   line, so that what is missing at their horizon is less than a pixel high. */
static const char *target_text(PovReader *reader)
{
    const double   STEEPEST = 5e-4 * 1e4;
    const PovView *view     = &reader->view;
    double         away     = distance3(view->location, view->look_at), target[3], along[3];
    add_scaled3(along, view->look_at, -1, view->location);
    double farther = view->orthographic ? 1 : fmax(1, view->horizon / STEEPEST / away);
    add_scaled3(target, view->location, farther, along);
    return point_text(reader, farther > 1 ? target : view->look_at);
}

static void write_camera(PovReader *reader)
{
    const PovView *view   = &reader->view;
    Text          *scene  = &reader->import->scene;
    double         aspect = length3(view->right) / length3(view->up);
    double         fov    = 2 * atan(length3(view->up) / 2 / distance_of_picture(view)) / DEGREE;
    import_mark(reader->import, view->line);
    text_format(scene, "\ncamera { // line %u\n    eye: %s,\n    target: %s,\n    up: %s,\n",
                view->line, point_text(reader, view->location), target_text(reader),
                point_text(reader, view->sky));
    write_lens(reader);
    if (view->spherical)
        text_add(scene, "    projection: \"panorama\"\n}\n");
    else if (view->orthographic)
        text_format(scene, "    projection: \"orthographic\",\n    height: %s\n}\n",
                    import_number_text(reader->import, length3(view->up)));
    else
        text_format(scene, "    fov: %sdeg\n}\n", import_number_text(reader->import, fov));
    int width = (int)lround(720 * fmin(fmax(aspect, 0.1), 10));
    if (width != 1280)
        text_format(scene, "image { size: [%d, 720] }\n", width);
}

/* Writes a spot: POV-Ray's angles are from the axis; here it is the whole one. */
static void write_spot(PovReader *reader, const PovLight *light)
{
    double falloff = fmin(fmax(light->falloff, 0.5), 89),
           full    = fmin(fmax(light->full, 0), falloff);
    text_format(&reader->import->scene, ", target: %s, angle: %sdeg, edge: %.3g",
                point_text(reader, light->target), import_number_text(reader->import, 2 * falloff),
                fmax(1 - full / falloff, 0.01));
}

/* Writes a light: POV-Ray's grow no weaker with distance, so they get as much stronger as they are
   far. */
static void write_light(PovReader *reader, const PovLight *light)
{
    const double FULL  = 3.14159265358979323846; /* a white surface is as bright as rgb 1 */
    Text        *scene = &reader->import->scene;
    double       away[3], color[3];
    for (int i = 0; i < 3; i++)
        color[i] = pov_light_of(reader, light->color[i]);
    double level = fmax(color[0], fmax(color[1], color[2]));
    add_scaled3(away, light->position, -1, light->target);
    double distance = distance3(light->position, reader->view.look_at);
    if (level <= 0)
        return;
    for (int i = 0; i < 3; i++)
        color[i] /= level;
    import_mark(reader->import, light->line);
    text_format(scene, "light { %s: %s, color: %s, intensity: %.6g%s",
                light->parallel ? "direction" : "position",
                point_text(reader, light->parallel ? away : light->position),
                import_vector_text(reader->import, color, 3),
                FULL * level * (light->parallel ? 1 : fmax(distance * distance, 1e-6)),
                light->shadowless ? ", shadow: false" : "");
    if (light->spot && !light->parallel)
        write_spot(reader, light);
    text_format(scene, " } // line %u\n", light->line);
}

void pov_finish_view(PovReader *reader)
{
    if (!reader->view.has_camera && reader->lights.count > 0)
        reader->view = usual_camera(reader->lights.items[0].line);
}

void pov_write_view(PovReader *reader)
{
    if (reader->view.has_camera)
        write_camera(reader);
    for (size_t i = 0; i < reader->lights.count; i++)
        write_light(reader, &reader->lights.items[i]);
    if (!reader->has_background && !reader->view.has_camera && reader->lights.count == 0)
        return; /* shapes alone have the usual light */
    double color[3];
    for (int i = 0; i < 3; i++)
        color[i] = fmin(pov_light_of(reader, reader->background[i]), 1);
    const char *sky = import_vector_text(reader->import, color, 3);
    text_format(&reader->import->scene, "sky { zenith: %s, horizon: %s, ground: %s }", sky, sky,
                sky);
    if (reader->has_background) {
        import_mark(reader->import, reader->background_line);
        text_format(&reader->import->scene, " // line %u", reader->background_line);
    }
    text_add(&reader->import->scene, "\n");
}

/*
 * import_pov_view.c: camera, lights and background of POV-Ray.
 */
#include <math.h>
#include <string.h>

#include "cli/import_pov_reader.h"
#include "compiler/base/vec.h"

static const double DEGREE = 3.14159265358979323846 / 180;

/* ---- reading ---- */

/* A word and the vector behind it; *taken: it is that word. */
static bool vector_of(PovReader *reader, const char *name, double v[3], bool *taken)
{
    if (*taken || !word_accept(&reader->words, name))
        return true;
    *taken = true;
    return pov_vector(reader, v);
}

static bool camera_word(PovReader *reader, PovView *view, Place *place)
{
    bool taken = false, angle = false;
    if (!pov_release(reader))
        return false;
    PovCell *own = pov_take(reader, POV_CAMERA);
    if (own) {
        *view = *own->view;
        return true;
    }
    if (word_accept(&reader->words, ";") || word_accept(&reader->words, ","))
        return true;
    double degrees[3] = {view->angle, 0, 0};
    bool   direction  = word_is(&reader->words, "direction");
    bool   looks      = word_is(&reader->words, "look_at");
    if (!vector_of(reader, "location", view->location, &taken) ||
        !vector_of(reader, "look_at", view->look_at, &taken) ||
        !vector_of(reader, "sky", view->sky, &taken) ||
        !vector_of(reader, "direction", view->direction, &taken) ||
        !vector_of(reader, "right", view->right, &taken) ||
        !vector_of(reader, "up", view->up, &taken) || !pov_place(reader, place, &angle))
        return false;
    view->has_direction = view->has_direction || direction;
    view->looks         = view->looks || looks;
    taken               = taken || angle;
    angle               = !taken && word_is(&reader->words, "angle");
    if (!vector_of(reader, "angle", degrees, &taken))
        return false;
    view->angle = degrees[0];
    if (taken)
        return true;
    if (word_accept(&reader->words, "perspective"))
        return true;
    if (word_accept(&reader->words, "orthographic"))
        return view->orthographic = true;
    return pov_leave_out(reader, "of the camera is");
}

bool pov_camera(PovReader *reader, PovView *view)
{
    Place    place     = place_identity();
    unsigned line      = reader->words.word.line;
    double   origin[3] = {0, 0, 0};
    *view              = (PovView){.has_camera = true,
                                   .sky        = {0, 1, 0},
                                   .direction  = {0, 0, 1},
                                   .right      = {4 / 3.0, 0, 0},
                                   .up         = {0, 1, 0},
                                   .line       = line};
    words_advance(&reader->words);
    if (!word_expect(&reader->words, "{"))
        return false;
    while (!word_is(&reader->words, "}"))
        if (!camera_word(reader, view, &place))
            return false;
    if (!view->looks)
        add_scaled3(view->look_at, view->location, 1, view->direction);
    if (view->angle >= 180) {
        import_note(reader->import, line, "an angle of %g degrees is one of 120 here", view->angle);
        view->angle = 120;
    }
    if (length3(view->direction) == 0 || length3(view->right) == 0 || length3(view->up) == 0 ||
        distance3(view->location, view->look_at) == 0 || !(view->angle >= 0 && view->angle < 180))
        return import_refuse(reader->import, line, "the camera shows nothing");
    if (view->right[0] < 0)
        import_note(reader->import, line, "`right` mirrors the picture; it is not mirrored here");
    place_apply(&place, origin, origin);
    place_apply(&place, view->location, view->location);
    place_apply(&place, view->look_at, view->look_at);
    place_apply(&place, view->sky, view->sky);
    add_scaled3(view->sky, view->sky, -1, origin);
    return word_expect(&reader->words, "}");
}

static bool light_word(PovReader *reader, PovLight *light, Place *place)
{
    bool taken = false;
    if (!pov_release(reader))
        return false;
    if (!pov_place(reader, place, &taken) || taken)
        return taken;
    if (word_accept(&reader->words, ";") || word_accept(&reader->words, ","))
        return true;
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
    Place place = place_identity();
    *light      = (PovLight){.line = reader->words.word.line, .color = {1, 1, 1}};
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
        if (!light_word(reader, light, &place))
            return false;
    place_apply(&place, light->position, light->position);
    place_apply(&place, light->target, light->target);
    return word_expect(&reader->words, "}");
}

bool pov_background(PovReader *reader)
{
    reader->background_line = reader->words.word.line;
    reader->has_background  = true;
    words_advance(&reader->words);
    double color[5];
    if (!word_expect(&reader->words, "{") || !pov_color(reader, color) ||
        !word_expect(&reader->words, "}"))
        return false;
    memcpy(reader->background, color, sizeof reader->background);
    return true;
}

/* ---- writing ---- */

static const char *point_text(PovReader *reader, const double q[3])
{
    double p[3];
    pov_point(q, p);
    return import_vector_text(reader->import, p, 3);
}

static void write_camera(PovReader *reader)
{
    const PovView *view   = &reader->view;
    Text          *scene  = &reader->import->scene;
    double         aspect = length3(view->right) / length3(view->up);
    /* The picture is `right` wide and `up` high, at the distance of `direction`.
   */
    double away = view->angle > 0 ? length3(view->right) / 2 / tan(view->angle * DEGREE / 2)
                                  : length3(view->direction);
    double fov  = 2 * atan(length3(view->up) / 2 / away) / DEGREE;
    import_mark(reader->import, view->line);
    text_format(scene, "\ncamera { // line %u\n    eye: %s,\n    target: %s,\n    up: %s,\n",
                view->line, point_text(reader, view->location), point_text(reader, view->look_at),
                point_text(reader, view->sky));
    if (view->orthographic)
        text_format(scene, "    projection: \"orthographic\",\n    height: %s\n}\n",
                    import_number_text(reader->import, length3(view->up)));
    else
        text_format(scene, "    fov: %sdeg\n}\n", import_number_text(reader->import, fov));
    int width = (int)lround(720 * fmin(fmax(aspect, 0.1), 10));
    if (width != 1280)
        text_format(scene, "image { size: [%d, 720] }\n", width);
}

/* POV-Ray's lights grow no weaker with distance, so they get as much stronger
 * as they are far. */
static void write_light(PovReader *reader, const PovLight *light)
{
    const double FULL  = 3; /* what rgb 1 is to a surface */
    Text        *scene = &reader->import->scene;
    double       level = fmax(light->color[0], fmax(light->color[1], light->color[2]));
    double       away[3], color[3];
    add_scaled3(away, light->position, -1, light->target);
    double distance = distance3(light->position, reader->view.look_at);
    if (level <= 0)
        return;
    for (int i = 0; i < 3; i++)
        color[i] = light->color[i] / level;
    import_mark(reader->import, light->line);
    text_format(scene, "light { %s: %s, color: %s, intensity: %.6g%s } // line %u\n",
                light->parallel ? "direction" : "position",
                point_text(reader, light->parallel ? away : light->position),
                import_vector_text(reader->import, color, 3),
                FULL * level * (light->parallel ? 1 : fmax(distance * distance, 1e-6)),
                light->shadowless ? ", shadow: false" : "", light->line);
}

void pov_write_view(PovReader *reader)
{
    if (reader->view.has_camera)
        write_camera(reader);
    for (size_t i = 0; i < reader->lights.count; i++)
        write_light(reader, &reader->lights.items[i]);
    if (!reader->has_background)
        return;
    double color[3];
    for (int i = 0; i < 3; i++)
        color[i] = fmin(reader->background[i], 1);
    const char *sky = import_vector_text(reader->import, color, 3);
    import_mark(reader->import, reader->background_line);
    text_format(&reader->import->scene, "sky { zenith: %s, horizon: %s, ground: %s } // line %u\n",
                sky, sky, sky, reader->background_line);
}

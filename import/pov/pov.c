/*
 * pov.c: scenes of POV-Ray: what they show.
 *
 * Shapes that scenes do not have are refused: a scene that lacks a part would
 * be another one.  Looks, light and settings that are not known are left out
 * and noted.
 */
#include "import/pov/pov.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "import/pov/reader.h"
#include "compiler/base/vec.h"

/* Blocks that change no shape. */
static const char *const settings[] = {"fog", "rainbow", "media", "atmosphere", "photons"};

/* ---- the file ---- */

/* Shows a part, with the material of `#default` unless it has one. */
static void show(PovReader *reader, Part *part)
{
    PovLook usual = reader->usual;
    if (!part)
        return;
    if ((usual.colored || usual.finished) && !part_is_painted(part)) {
        usual.said = true;
        part       = part_around(reader->import, part->line, part->stem, part);
        part->look = pov_look_text(reader, &usual);
    } else if (!part_is_painted(part)) {
        import_note(reader->import, part->line, "what has no pigment is grey, not black");
    }
    part_add(reader->import, reader->shown, part);
}

static bool show_object(PovReader *reader)
{
    Part *part;
    if (!pov_object(reader, &part))
        return false;
    show(reader, part);
    return true;
}

static bool add_light(PovReader *reader)
{
    PovLight light;
    if (!pov_light(reader, &light))
        return false;
    array_push(reader->import->arena, &reader->lights, light);
    return true;
}

static bool statement(PovReader *reader)
{
    WordReader *words = &reader->words;
    PovCell    *own;
    if (word_is(words, "camera"))
        return pov_camera(reader, &reader->view);
    if (word_is(words, "light_source"))
        return add_light(reader);
    if (word_is(words, "default"))
        return pov_default(reader) && word_expect(words, "}");
    if (word_is(words, "background"))
        return pov_background(reader);
    if (word_is(words, "sky_sphere"))
        return pov_sky_sphere(reader);
    if (word_is(words, "global_settings"))
        return pov_settings(reader);
    if (word_among(&reader->words, settings))
        return pov_leave_out(reader, "is");
    if (pov_object_follows(reader))
        return show_object(reader);
    if ((own = pov_take(reader, POV_OBJECT))) {
        show(reader, own->part);
        return true;
    }
    if (words->word.kind == IMPORT_WORD_NAME)
        return import_refuse(reader->import, words->word.line, "`%.40s` is not translated",
                             words->word.text);
    return word_accept(words, ";") || word_refuse(words, "an object such as `sphere`");
}

/* Reads a statement; behind an object that is refused, --keep-going goes on. */
static bool statement_or_less(PovReader *reader)
{
    unsigned line = reader->words.word.line;
    PovState state;
    pov_keep_state(reader, &state);
    if (import_was_left_out(reader->import, line) && reader->words.word.kind == IMPORT_WORD_NAME &&
        pov_object_follows(reader)) {
        words_advance(&reader->words);
        return pov_skip_block(reader);
    }
    if (statement(reader))
        return true;
    if (state.word.kind != IMPORT_WORD_NAME || !import_leaves_out(reader->import, line))
        return false;
    pov_restore_state(reader, &state);
    words_advance(&reader->words);
    return word_is(&reader->words, "{") ? pov_skip_block(reader) : true;
}

static void add_placed(PovReader *reader, Part *part, const Transform *transform, const char *look,
                       bool outside)
{
    Part *placed      = part_around(reader->import, part->line, part->stem, part);
    placed->transform = *transform;
    placed->look      = look;
    placed->outside   = outside;
    part_add(reader->import, reader->shown, placed);
}

/* Adds a part as it is seen.  POV-Ray's rays begin inside of solids, too, and see their surface
   from there.  Here they would end where they begin, so that such a solid becomes what is outside
   of it, which has the same surface.  Parts of a union come apart: what is inside of one of them is
   seen. */
static void add_seen(PovReader *reader, Part *part, const Transform *transform, const char *look)
{
    Transform back = *transform, all = transform_chain(&part->transform, transform);
    double    eye[3];
    pov_point(reader->view.location, eye);
    bool inside = transform_invert(&back);
    transform_apply(&back, eye, eye);
    inside = inside && part_holds(part, eye);
    if (!inside || part->shape || part->join != PART_UNION || part->methods || part->outside) {
        add_placed(reader, part, transform, look, inside);
        return;
    }
    for (size_t i = 0; i < part->parts.count; i++)
        add_seen(reader, part->parts.items[i], &all, part->look ? part->look : look);
}

/* Tells how far the planes of a part are from a point at most. */
static double farthest_plane(const Part *part, const Transform *around, const double point[3])
{
    Transform transform = transform_chain(&part->transform, around), back = transform;
    double    most = 0, p[3], foot[3];
    if (part->inside.kind == PART_HALF_SPACE && transform_invert(&back)) {
        const double *n = part->inside.numbers;
        transform_apply(&back, point, p);
        add_scaled3(foot, p, n[3] - dot3(n, p), n);
        transform_apply(&transform, foot, foot);
        most = distance3(foot, point);
    }
    for (size_t i = 0; i < part->parts.count; i++)
        most = fmax(most, farthest_plane(part->parts.items[i], &transform, point));
    return most;
}

static void look_around(PovReader *reader)
{
    Part     *all  = reader->shown, *part;
    Transform here = transform_identity();
    double    eye[3];
    pov_point(reader->view.location, eye);
    reader->shown        = part_new(reader->import, all->line, all->stem);
    reader->view.horizon = farthest_plane(all, &here, eye);
    for (size_t i = 0; i < all->parts.count; i++) {
        part = all->parts.items[i];
        if (part_holds(part, eye))
            add_seen(reader, part, &here, NULL);
        else
            part_add(reader->import, reader->shown, part);
    }
}

/* Mirrors space once more if the camera mirrors its picture. */
static void mirror(PovReader *reader)
{
    Part     *all  = reader->shown;
    Transform back = transform_scale((double[]){1, 1, -1});
    reader->shown  = part_new(reader->import, all->line, all->stem);
    for (size_t i = 0; i < all->parts.count; i++)
        add_placed(reader, all->parts.items[i], &back, NULL, false);
}

static bool write(PovReader *reader)
{
    Import    *import = reader->import;
    PartWriter writer = {.import = import, .inner_looks = true};
    pov_finish_view(reader);
    bool mirrored = reader->view.mirrored;
    if (reader->view.has_camera)
        look_around(reader);
    if (mirrored)
        mirror(reader);
    import_write_head(import);
    text_add(&import->scene,
             mirrored ? "// The camera mirrors its picture, so that each z has its own sign.\n"
                      : "// POV-Ray's z points away from the eye: each z has the other sign.\n");
    if (reader->materials.length > 0)
        text_add(&import->scene, reader->materials.bytes);
    for (size_t i = 0; i < reader->shown->parts.count; i++)
        if (!part_show(&writer, reader->shown->parts.items[i], ""))
            return false;
    pov_write_view(reader);
    return true;
}

/* Reads all of it, with colours in a space of this exponent. */
static bool read(PovReader *reader, double gamma)
{
    Import *import = reader->import;
    *reader        = (PovReader){.import      = import,
                                 .materials   = {.arena = import->arena},
                                 .usual       = pov_usual_look(),
                                 .gamma       = gamma,
                                 .found_gamma = -1,
                                 .ambient     = {1, 1, 1}};
    reader->shown  = part_new(import, 1, "shown");
    pov_start(reader);
    while (reader->words.word.kind != IMPORT_WORD_END)
        if (!statement_or_less(reader))
            return false;
    if (import->refusal.length > 0)
        return false;
    return reader->shown->parts.count > 0 ||
           import_refuse(import, reader->words.line, "nothing is shown");
}

bool import_pov(Import *import)
{
    PovReader reader = {.import = import};
    if (!read(&reader, 1))
        return false;
    /* Colours are linear from 3.7 on, unless a file says otherwise; before, they were shown as they
       are. */
    double gamma = reader.found_gamma >= 0 ? reader.found_gamma : reader.version >= 3.7 ? 1 : 0;
    return (gamma == 1 || read(&reader, gamma)) && write(&reader);
}

/* beams.c: components that are unions of capsules and balls, as beams. */
#include "cli/mesh/meshing.h"
#include "compiler/base/vec.h"

KrsStatus check_beams(const Meshing *meshing)
{
    const Options *options = meshing->options;
    for (size_t i = 0; options->mesh_beams && i < output_count(meshing); i++)
        if (!mesh_format(output_path(meshing, i))->has_beams)
            return say_usage(options, "--beams is for .3mf, and `%s` has triangles only",
                             output_path(meshing, i));
    if (options->mesh_beams && options->within.given)
        return say_usage(options, "--within cuts beams, and --beams are whole; one of both");
    return KRS_OK;
}

/* Tells whether a file can have all beams: it has neither balls nor beams without radius. */
static bool are_beams(const KrsBeam *beams, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(distance3(beams[i].ends[0], beams[i].ends[1]) > 0) || !(beams[i].radii[0] > 0) ||
            !(beams[i].radii[1] > 0))
            return false;
    return count > 0;
}

bool add_beams(const Meshing *meshing, size_t component, Bodies *bodies)
{
    Arena *arena = meshing->options->arena;
    Body   body  = {.component = component};
    if (component == 0 && krs_component_count(meshing->scene) > 1)
        return false;
    size_t index    = component > 0 ? component - 1 : 0;
    body.beam_count = krs_component_beams(meshing->state, index, NULL);
    body.beams      = arena_new_array(arena, KrsBeam, body.beam_count + 1);
    krs_component_beams(meshing->state, index, body.beams);
    if (!are_beams(body.beams, body.beam_count))
        return false;
    array_push(arena, bodies, body);
    return true;
}

/* Takes the beams of a body, with the color in the middle of the first one's side. */
void take_beams(const Meshing *meshing, const Body *body, MeshBody *to)
{
    KrsHit hit;
    double middle[3];
    to->beams      = body->beams;
    to->beam_count = body->beam_count;
    if (body->beam_count == 0)
        return;
    for (int k = 0; k < 3; k++)
        middle[k] = 0.5 * (body->beams[0].ends[0][k] + body->beams[0].ends[1][k]);
    krs_probe(meshing->state, (const double(*)[3])middle, 1, &hit);
    for (int k = 0; k < 3; k++)
        to->color[k] = color_byte(hit.color[k]);
}

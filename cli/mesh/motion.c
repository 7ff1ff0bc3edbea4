/*
 * motion.c: how copies move from frame to frame, as keyframes.
 *
 * Each frame is a keyframe.  Between two of them a program rotates a copy at an even speed and
 * moves it straight on.  Where that is not where the copy belongs, as far as seven places between
 * tell, there is another keyframe in the middle, and so on.
 */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "cli/mesh/meshing.h"

enum { MAX_HALVINGS = 10, PLACES = 7 };
/* Parts of the time between two keyframes.  They are uneven, so that what shakes is not met at rest each time;
   one is the middle. */
static const double SHARES[PLACES] = {0.083, 0.219, 0.347, 0.5, 0.638, 0.791, 0.926};
static const double MAX_SAMPLES    = 1e7; /* copies times frames */

typedef double Matrix[3][4];

typedef struct Track {
    MeshKey *items;
    size_t   count, capacity;
} Track;

typedef struct Motion {
    const Meshing *meshing;
    KrsAssembly   *assembly;
    size_t         copies, sampled;
    double         tolerance;
    double (*lows)[3], (*highs)[3]; /* boxes of the meshes of copies */
    Track  *tracks;
    Matrix *places[MAX_HALVINGS + 1][PLACES];
    bool   *wanting[MAX_HALVINGS + 1]; /* copies that need a keyframe in the middle */
    Matrix *to;                        /* what is being sampled */
    double  farthest;                  /* from where they belong that copies are, but in jumps */
    size_t  jumps; /* times between the nearest keyframes in which a copy goes farther */
} Motion;

static double seconds_of(const Motion *motion, double frame)
{
    return (frame - motion->meshing->options->first_frame) / motion->meshing->options->fps;
}

static bool take_matrix(void *user, const KrsItem *item, const double matrix[3][4])
{
    Motion *motion = user;
    (void)item;
    memcpy(motion->to[motion->sampled++], matrix, sizeof *motion->to);
    return true;
}

static KrsStatus sample(Motion *motion, double frame, Matrix *matrices)
{
    const Options *options = motion->meshing->options;
    KrsStatus      status  = scene_set_time(options, motion->meshing->state,
                                            options->time + frame / options->fps);
    if (status != KRS_OK)
        return status;
    status = krs_assembly_transform(motion->meshing->state, motion->assembly);
    if (status == KRS_BAD_SCENE)
        say("at frame %g a mirror cuts what moves", frame);
    motion->to      = matrices;
    motion->sampled = 0;
    if (status == KRS_OK)
        krs_assembly_visit(motion->assembly, take_matrix, motion);
    return status;
}

static void push_key(Motion *motion, size_t copy, double frame, const Matrix matrix)
{
    MeshKey key = {.time = seconds_of(motion, frame)};
    mesh_pose_of(matrix, &key.pose);
    array_push(motion->meshing->options->arena, &motion->tracks[copy], key);
}

/* Returns the largest distance of a point of the copy from where it belongs: both places are
   affine, so it is that of a corner of a box around it. */
static double distance_between(const Motion *motion, size_t copy, const MeshPose *pose,
                               const Matrix belongs)
{
    double most = 0;
    for (int corner = 0; corner < 8; corner++) {
        double point[3], image[3], away = 0;
        for (int k = 0; k < 3; k++)
            point[k] = corner >> k & 1 ? motion->highs[copy][k] : motion->lows[copy][k];
        mesh_pose_apply(pose, point, image);
        for (int i = 0; i < 3; i++) {
            double at = belongs[i][0] * point[0] + belongs[i][1] * point[1] +
                        belongs[i][2] * point[2] + belongs[i][3];
            away += (image[i] - at) * (image[i] - at);
        }
        most = fmax(most, sqrt(away));
    }
    return most;
}

/* Returns how far a copy is from where it belongs between two keyframes. */
static double distance_of(const Motion *motion, size_t copy, Matrix *const ends[2],
                          Matrix *const places[PLACES])
{
    MeshPose first, last, between;
    double   most = 0;
    mesh_pose_of((const double(*)[4])ends[0][copy], &first);
    mesh_pose_of((const double(*)[4])ends[1][copy], &last);
    for (int i = 0; i < PLACES; i++) {
        mesh_pose_between(&first, &last, SHARES[i], &between);
        most = fmax(most,
                    distance_between(motion, copy, &between, (const double(*)[4])places[i][copy]));
    }
    return most;
}

/* Tells whether it must have another keyframe in the middle, if there can be one. */
static bool wants_key(Motion *motion, size_t copy, Matrix *const ends[2],
                      Matrix *const places[PLACES], bool can)
{
    const double distance = distance_of(motion, copy, ends, places);
    const bool   wants    = distance > motion->tolerance;
    if (!wants)
        motion->farthest = fmax(motion->farthest, distance);
    else if (!can)
        motion->jumps++;
    return wants && can;
}

static void make_room(Motion *motion, int depth)
{
    Arena *arena = motion->meshing->options->arena;
    if (motion->wanting[depth])
        return;
    motion->wanting[depth] = arena_new_array(arena, bool, motion->copies);
    for (int i = 0; i < PLACES; i++)
        motion->places[depth][i] = arena_alloc(arena, motion->copies, sizeof(Matrix));
}

/* Tells whether a time between two fits: times of the file are in single precision, and must grow. */
static bool can_be_halved(const Motion *motion, const double frames[2])
{
    float middle = (float)seconds_of(motion, 0.5 * (frames[0] + frames[1]));
    return middle > (float)seconds_of(motion, frames[0]) &&
           middle < (float)seconds_of(motion, frames[1]);
}

/* Adds keyframes between two, for the copies that are `asked`. */
static KrsStatus refine(Motion *motion, const double frames[2], Matrix *const ends[2],
                        const bool *asked, int depth)
{
    const bool can = depth < MAX_HALVINGS && can_be_halved(motion, frames);
    bool       any = false;
    make_room(motion, depth);
    Matrix  **places = motion->places[depth];
    bool     *wanted = motion->wanting[depth];
    KrsStatus status = KRS_OK;
    for (int i = 0; i < PLACES && status == KRS_OK; i++)
        status = sample(motion, frames[0] + (frames[1] - frames[0]) * SHARES[i], places[i]);
    for (size_t i = 0; i < motion->copies && status == KRS_OK; i++) {
        wanted[i] = (!asked || asked[i]) && wants_key(motion, i, ends, places, can);
        any       = any || wanted[i];
    }
    if (!any)
        return status;
    double        middle     = 0.5 * (frames[0] + frames[1]);
    double        halves[3]  = {frames[0], middle, frames[1]};
    Matrix *const corners[3] = {ends[0], places[PLACES / 2], ends[1]};
    status                   = refine(motion, halves, corners, wanted, depth + 1);
    for (size_t i = 0; i < motion->copies; i++)
        if (wanted[i])
            push_key(motion, i, middle, (const double(*)[4])corners[1][i]);
    return status == KRS_OK ? refine(motion, halves + 1, corners + 1, wanted, depth + 1) : status;
}

static KrsStatus sample_all(Motion *motion)
{
    const Options *options = motion->meshing->options;
    Matrix        *ends[2];
    for (int i = 0; i < 2; i++)
        ends[i] = arena_alloc(options->arena, motion->copies, sizeof(Matrix));
    KrsStatus status = sample(motion, options->first_frame, ends[0]);
    for (size_t i = 0; i < motion->copies && status == KRS_OK; i++)
        push_key(motion, i, options->first_frame, (const double(*)[4])ends[0][i]);
    for (uint32_t frame = options->first_frame; frame < options->last_frame && status == KRS_OK;
         frame++) {
        const double frames[2] = {frame, frame + 1.0};
        status                 = sample(motion, frame + 1.0, ends[1]);
        if (status == KRS_OK)
            status = refine(motion, frames, ends, NULL, 0);
        for (size_t i = 0; i < motion->copies && status == KRS_OK; i++)
            push_key(motion, i, frame + 1.0, (const double(*)[4])ends[1][i]);
        memcpy(ends[0], ends[1], motion->copies * sizeof(Matrix));
        if (!mesh_is_wanted(motion->meshing))
            status = KRS_INTERRUPTED;
    }
    return status;
}

/* ---- copies ---- */

static bool take_box(void *user, const KrsItem *item, const double matrix[3][4])
{
    Motion *motion = user;
    (void)matrix;
    double *low = motion->lows[motion->sampled], *high = motion->highs[motion->sampled];
    for (int k = 0; k < 3; k++) {
        low[k]  = HUGE_VAL;
        high[k] = -HUGE_VAL;
    }
    for (size_t i = 0; i < item->mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            low[k]  = fmin(low[k], item->mesh->vertices[i][k]);
            high[k] = fmax(high[k], item->mesh->vertices[i][k]);
        }
    for (int k = 0; k < 3 && item->mesh->vertex_count == 0; k++)
        low[k] = high[k] = 0;
    motion->sampled++;
    return true;
}

/* The sign of a quaternion is free: it is that by which it is near the one before. */
static void choose_signs(Track *track)
{
    for (size_t i = 1; i < track->count; i++) {
        double *now = track->items[i].pose.rotation, cosine = 0;
        for (int n = 0; n < 4; n++)
            cosine += now[n] * track->items[i - 1].pose.rotation[n];
        for (int n = 0; n < 4 && cosine < 0; n++)
            now[n] = -now[n];
    }
}

/* Ends a track, which keeps its first keyframe alone if nothing moves. */
static void end_track(Track *track)
{
    bool still = true;
    choose_signs(track);
    for (size_t i = 1; i < track->count && still; i++)
        still = memcmp(&track->items[i].pose, &track->items[0].pose,
                       offsetof(MeshPose, mirrored)) == 0;
    if (still)
        track->count = 1;
}

static KrsStatus find_tracks(Meshing *meshing, MeshBody *body)
{
    const Options *options = meshing->options;
    Arena         *arena   = options->arena;
    size_t         copies  = (size_t)body->assembly->copies;
    Motion         motion  = {.meshing   = meshing,
                              .assembly  = body->assembly,
                              .copies    = copies,
                              .tolerance = assembly_error(body->assembly)};
    if (body->assembly->copies * (options->last_frame - options->first_frame + 1.0) > MAX_SAMPLES)
        return say_usage(options, "`%s` has %zu copies, which are too many for so many --frames",
                         options->files.items[0], copies);
    motion.lows   = arena_alloc(arena, copies, sizeof *motion.lows);
    motion.highs  = arena_alloc(arena, copies, sizeof *motion.highs);
    motion.tracks = arena_new_array(arena, Track, copies);
    krs_assembly_visit(body->assembly, take_box, &motion);
    KrsStatus status = sample_all(&motion);
    if (status == KRS_OK) /* all else is that of the first frame */
        status = sample(&motion, options->first_frame, arena_alloc(arena, copies, sizeof(Matrix)));
    MeshTrack *tracks = arena_new_array(arena, MeshTrack, copies);
    for (size_t i = 0; i < copies && status == KRS_OK; i++) {
        end_track(&motion.tracks[i]);
        tracks[i] = (MeshTrack){motion.tracks[i].items, motion.tracks[i].count};
        meshing->moving += tracks[i].count > 1;
        meshing->keys += tracks[i].count > 1 ? tracks[i].count : 0;
    }
    body->tracks      = tracks;
    meshing->farthest = fmax(meshing->farthest, motion.farthest);
    meshing->jumps += motion.jumps;
    return status;
}

KrsStatus find_motion(Meshing *meshing, MeshParts *parts)
{
    const Options *options = meshing->options;
    KrsStatus      status  = KRS_OK;
    MeshBody      *bodies  = arena_new_array(options->arena, MeshBody, parts->body_count);
    meshing->moving = meshing->keys = meshing->jumps = 0;
    meshing->farthest                                = 0;
    for (size_t i = 0; i < parts->body_count && status == KRS_OK; i++) {
        bodies[i] = parts->bodies[i];
        if (bodies[i].assembly)
            status = find_tracks(meshing, &bodies[i]);
    }
    parts->bodies = bodies;
    return status;
}

/* ---- what is asked for ---- */

typedef struct Named {
    Text   names;
    size_t count;
} Named;

static void add_name(Named *named, const char *name)
{
    enum { MAX_NAMED = 8 };
    if (named->count < MAX_NAMED)
        text_format(&named->names, "%s`%s`", named->count ? ", " : "", name);
    else if (named->count == MAX_NAMED)
        text_add(&named->names, " and others");
    named->count++;
}

static KrsStatus check_files(const Meshing *meshing)
{
    for (size_t i = 0; i < output_count(meshing); i++)
        if (!mesh_format(output_path(meshing, i))->has_motion)
            return say_usage(meshing->options,
                             "--frames is for .glb, and `%s` has neither times nor parts that move",
                             output_path(meshing, i));
    if (meshing->options->mesh_copies > 0)
        return say_usage(meshing->options,
                         "--frames moves parts of a file, so --copies must be instances");
    if (meshing->options->mesh_lods > 0)
        return say_usage(meshing->options,
                         "parts that move are copies, which have no --lods; --frames or --lods");
    if (meshing->options->first_frame == meshing->options->last_frame)
        return say_usage(meshing->options,
                         "nothing moves in one frame; --frames says the first and "
                         "the last, as in --frames 0..48");
    return KRS_OK;
}

KrsStatus check_motion(const Meshing *meshing)
{
    const Options *options = meshing->options;
    Named          deforms = {.names = {.arena = options->arena}}, recolors = deforms;
    bool           moves  = false;
    KrsStatus      status = options->animated ? check_files(meshing) : KRS_OK;
    if (!options->animated || status != KRS_OK)
        return status;
    for (size_t i = 0; i < krs_component_count(meshing->scene); i++) {
        KrsMotion    motion;
        KrsComponent component;
        if (meshing->how.component > 0 && meshing->how.component != i + 1)
            continue;
        if (krs_component_motion(meshing->scene, i, &motion) != KRS_OK)
            continue;
        krs_component(meshing->scene, i, &component);
        moves = moves || motion.moves;
        if (motion.deforms)
            add_name(&deforms, component.name);
        if (motion.recolors)
            add_name(&recolors, component.name);
    }
    if (deforms.count > 0)
        return say_usage(options,
                         "the time changes the form or the size of %s; --frames has what it moves "
                         "and turns, in unions that nothing is cut from",
                         deforms.names.bytes);
    if (recolors.count > 0 && !options->quiet)
        say("warning: the time changes the material of %s, which stays that of frame %u",
            recolors.names.bytes, options->first_frame);
    if (!moves && !options->quiet)
        say("warning: nothing in `%s` moves with the time", options->files.items[0]);
    return KRS_OK;
}

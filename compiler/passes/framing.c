/*
 * framing.c: places a camera in a scene that has none.
 *
 * Boxes of sequences hold for all values of the parameters, so they are often much too large.  In a
 * picture of the whole box the scene would be tiny.  So a few hundred rays are cast from a sphere
 * around the box to points inside of it, and the camera frames what they hit.
 *
 * Such rays miss most of what is thin.  So what lies outside of the box around the hits is divided
 * into cells, down to small ones, and a cell is left out when the distance at its middle shows that it
 * is empty.  Further rays go to the cells that remain.
 *
 * The picture does not depend on whether parts are an instance group: rays and their number are as without.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"
#include "compiler/passes/compilation.h"
#include "compiler/graph/lanes/lanes.h"
#include "compiler/shape/box.h"

enum { RAYS = 512, FEWEST_RAYS = 64, ROUNDS = 3, BATCH = LANES, MAX_UNRESOLVED = 4 };
/* Cells are halved this many times, along their longest side; and so many are tried at once for each
   ray that is cast. */
enum { HALVINGS = 15, CELLS_A_RAY = 4, MAX_CELLS = RAYS * CELLS_A_RAY };
/* Fewer points do not tell how large something is. */
enum { FEWEST_SEEN = 8 };
/* The ball of the picture is larger than that of the hits by this, since rays miss some of the
   surface. */
static const double MARGIN = 0.06, GOLDEN_ANGLE = 2.399963229728653; /* pi (3 - sqrt 5) */

/* If the distance has more flops, fewer rays are cast, so that placing a camera takes little
   time. */
static const double FLOPS_OF_ALL_RAYS = 2500;

/* Nor do rays take more steps or operations than this, whatever each of them needs: those of a round at
   most a part of what is left, so that there is something for the next one. */
enum { MAX_STEPS = 1000, SHARE = 3 };
static const uint64_t MAX_OPERATIONS = 40000000;

/* Rays are cast in an order whose beginnings are spread as all of it, whether or not there is time for
   all: this has no factor in common with their number. */
enum { STRIDE = 7919 };

/* Rays of one round, and what those of all rounds have hit of bounded components. */
typedef struct Rays {
    double     origins[RAYS][3], directions[RAYS][3];
    KrsHit     hits[BATCH];
    double     seen[2 * ROUNDS * RAYS][3];
    size_t     seen_count;
    Box        box;    /* around what is seen */
    const Box *boxes;  /* of components in the state: state_find_boxes */
    bool       apart;  /* they keep away from what has no end, as a floor */
    uint64_t   most;   /* operations of the state, at the end */
    RayLimits  limits; /* of the round */
} Rays;

static Box box_of_point(const double point[3])
{
    return (Box){{range_of(point[0]), range_of(point[1]), range_of(point[2])}};
}

static bool is_costly(const KrsScene *scene, int rays)
{
    return rays * tape_flops_separate(&scene->distance) > RAYS * FLOPS_OF_ALL_RAYS;
}

/* Returns the number of rays: a power of two, so that it has no factor in common with the strides
   of make_rays, which are odd. */
static int count_rays(const KrsScene *scene)
{
    int count = RAYS;
    while (count > FEWEST_RAYS && is_costly(scene, count))
        count /= 2;
    return count;
}

/* Returns the place of the i-th ray that is cast among `count` of them. */
static int spread(int i, int count) { return i * STRIDE % count; }

/* Makes the i-th ray that is cast: from a lattice of `count` points that are spread evenly on a sphere
   around the ball (Fibonacci's) to a point, which is given in radii of the ball from its centre. */
static void make_ray(const Ball *ball, int i, int count, const double to[3], Rays *rays)
{
    int    place = spread(i, count);
    double y = 1 - (2 * place + 1.0) / count, ring = sqrt(1 - y * y), angle = GOLDEN_ANGLE * place;
    double from[3] = {ring * real_cos(angle), rays->apart ? fabs(y) : y, ring * real_sin(angle)};
    for (int k = 0; k < 3; k++) {
        rays->origins[i][k]    = ball->centre[k] + 1.01 * ball->radius * from[k];
        rays->directions[i][k] = to[k] - 1.01 * from[k];
    }
}

/* Makes rays to the points of a second lattice inside of the ball. */
static void make_rays(const Ball *ball, int count, Rays *rays)
{
    for (int i = 0; i < count; i++) {
        int    place = spread(i, count);
        double depth = 0.9 * real_cbrt((place * 89 % count + 0.5) / count);
        double turn  = GOLDEN_ANGLE * (place * 37 % count);
        double up = 1 - (2 * (place * 53 % count) + 1.0) / count, side = sqrt(1 - up * up);
        make_ray(
            ball, i, count,
            (double[]){depth * side * real_cos(turn), depth * up, depth * side * real_sin(turn)},
            rays);
    }
}

static void begin_round(const KrsState *state, Rays *rays)
{
    uint64_t left = state->ran < rays->most ? rays->most - state->ran : 0;
    rays->limits  = (RayLimits){MAX_STEPS, state->ran + left / SHARE};
}

static void note_hit(KrsState *state, const KrsHit *hit, Rays *rays)
{
    if (!hit->hit || !box_is_finite(state_box(state, rays->boxes, hit->component - 1)))
        return;
    memcpy(rays->seen[rays->seen_count++], hit->point, sizeof hit->point);
    rays->box = box_hull(rays->box, box_of_point(hit->point));
}

/* Casts rays and notes what they hit of bounded components, as long as they do not take too much; false
   after a few unresolved ones.  Distances that are much too short need many steps, and then the camera
   is placed by what is seen so far. */
static bool cast_rays(KrsState *state, Rays *rays, int count, double radius)
{
    const uint64_t most       = rays->limits.ran;
    int            unresolved = 0;
    for (int i = 0; i < count && unresolved <= MAX_UNRESOLVED && state->ran < most; i += BATCH) {
        int now = count - i < BATCH ? count - i : BATCH;
        if (state_raycast(state, (const double(*)[3])rays->origins + i,
                          (const double(*)[3])rays->directions + i, (size_t)now, 4 * radius,
                          1e-3 * radius, rays->limits, rays->hits) != KRS_OK)
            return false;
        for (const KrsHit *hit = rays->hits; hit < rays->hits + now; hit++) {
            note_hit(state, hit, rays);
            unresolved += hit->unresolved && state->ran < most;
        }
    }
    return unresolved <= MAX_UNRESOLVED;
}

/* Shrinks the ball to that around the box of what is seen, with a margin, no larger than it was;
   false where there is too little to be seen. */
static bool shrink_ball(Box seen, Ball *ball)
{
    Ball inner = ball_around(seen);
    if (!(inner.radius > 1e-3 * ball->radius))
        return false;
    inner.radius = fmin(ball->radius, (1 + MARGIN) * inner.radius);
    *ball        = inner;
    return true;
}

/* Moves the ball to the middle of what is seen, and makes it as large as is needed there.  A ball that
   nothing has made smaller yet tells nothing. */
static void grow_ball(const Rays *rays, double most, Ball *ball)
{
    if (!(ball->radius < most))
        ball->radius = 0;
    box_centre(rays->box, ball->centre);
    for (size_t i = 0; i < rays->seen_count; i++)
        ball->radius = fmax(ball->radius, (1 + MARGIN) * distance3(rays->seen[i], ball->centre));
    ball->radius = fmin(ball->radius, most);
}

/* ---- what rays have missed ---- */

/* Cells that may not be empty, and what is asked of them. */
typedef struct Cells {
    Box    boxes[2 * MAX_CELLS];
    double middles[2 * MAX_CELLS][3], distances[2 * MAX_CELLS];
    size_t count;
} Cells;

static bool is_inside(const Box *cell, const Box *box)
{
    for (int k = 0; k < 3; k++)
        if (cell->axis[k].low < box->axis[k].low || cell->axis[k].high > box->axis[k].high)
            return false;
    return true;
}

static double width_of(Range range) { return range.high - range.low; }

/* Halves all cells along their longest sides. */
static void halve_cells(Cells *cells)
{
    for (size_t i = 0; i < cells->count; i++) {
        Box halves[2];
        box_halve(cells->boxes[i], halves);
        cells->boxes[i]                = halves[0];
        cells->boxes[cells->count + i] = halves[1];
    }
    cells->count *= 2;
}

/* Leaves out the cells that are inside of a box, and those that the distance at their middle shows
   to be empty. */
static void reduce_cells(KrsState *state, const Box *known, Cells *cells)
{
    size_t outside = 0, kept = 0;
    for (size_t i = 0; i < cells->count; i++)
        if (!is_inside(&cells->boxes[i], known)) {
            cells->boxes[outside] = cells->boxes[i];
            box_centre(cells->boxes[i], cells->middles[outside++]);
        }
    if (krs_distance(state, (const double(*)[3])cells->middles, outside, cells->distances) !=
        KRS_OK)
        outside = 0;
    for (size_t i = 0; i < outside; i++)
        if (!(cells->distances[i] > 0.5 * box_diagonal(cells->boxes[i]))) {
            memcpy(cells->middles[kept], cells->middles[i], sizeof *cells->middles);
            cells->boxes[kept++] = cells->boxes[i];
        }
    cells->count = kept;
}

/* Leaves out the cells that are next to what has no end. */
static void keep_separate(KrsState *state, const Rays *rays, Cells *cells)
{
    size_t kept = 0;
    state_refresh_points(state);
    for (size_t i = 0; i < cells->count && state->ran < rays->limits.ran; i++) {
        uint32_t nearest = state_nearest_component(state, cells->middles[i]);
        if (nearest == 0 || !box_is_finite(state_box(state, rays->boxes, nearest - 1)))
            continue;
        memcpy(cells->middles[kept], cells->middles[i], sizeof *cells->middles);
        cells->boxes[kept++] = cells->boxes[i];
    }
    cells->count = kept;
}

/* Finds cells of a box that may not be empty and are not inside of another one.  Where there are too
   many they remain larger. */
static void find_cells(KrsState *state, Box box, const Rays *rays, const Box *known, size_t most,
                       Cells *cells)
{
    cells->count    = 1;
    cells->boxes[0] = box;
    for (int i = 0; i < HALVINGS && cells->count <= most && state->ran < rays->limits.ran; i++) {
        halve_cells(cells);
        reduce_cells(state, known, cells);
        if (rays->apart)
            keep_separate(state, rays, cells);
    }
}

/* Makes a ray from around the ball to the point of a surface that is next to the middle of a cell, as
   far as distance and normal there tell it. */
static void make_ray_to_cell(KrsState *state, const Ball *ball, int i, int count,
                             const double middle[3], Rays *rays)
{
    KrsHit near = {.distance = 0};
    double to[3];
    krs_probe(state, (const double(*)[3])middle, 1, &near);
    for (int k = 0; k < 3; k++)
        to[k] = (middle[k] - near.distance * near.normal[k] - ball->centre[k]) / ball->radius;
    make_ray(ball, i, count, to, rays);
}

/* Casts rays to cells in which there may be something that is not seen yet, until none hits anything
   outside of what is seen and a margin. */
static void search_beyond(KrsState *state, Box box, int most, double margin, Cells *cells,
                          Rays *rays)
{
    Ball outer = ball_around(box);
    bool more  = true;
    for (int round = 0; round < ROUNDS && more; round++) {
        Box known = box_grow(rays->box, margin);
        begin_round(state, rays);
        find_cells(state, box, rays, &known, (size_t)most * CELLS_A_RAY, cells);
        int wanted = cells->count < (size_t)most ? (int)cells->count : most, count = 0;
        /* If there are more cells than rays, to some. */
        for (; count < wanted && state->ran < rays->limits.ran; count++) {
            size_t cell = (size_t)spread(count, wanted) * cells->count / (size_t)wanted;
            make_ray_to_cell(state, &outer, count, wanted, cells->middles[cell], rays);
        }
        more = cast_rays(state, rays, count, outer.radius) && !is_inside(&rays->box, &known);
    }
}

/* Shrinks the ball to that around what rays hit: each round makes it smaller, and so the rays of
   the next one denser.  False when rays cost too much. */
static bool cast_rounds(KrsState *state, int count, Rays *rays, Ball *ball)
{
    for (int round = 0; round < ROUNDS; round++) {
        begin_round(state, rays);
        make_rays(ball, count, rays);
        if (!cast_rays(state, rays, count, ball->radius))
            return false;
        if (!shrink_ball(rays->box, ball))
            return true;
    }
    return true;
}

/* Finds the ball that the picture shows, within the one of the box: around what rays hit, and around
   what they have missed. */
static void look_for_ball(KrsState *state, Box box, Rays *rays, Cells *cells, Ball *ball)
{
    double most      = ball->radius;
    int    count     = count_rays(state->scene);
    rays->seen_count = 0;
    rays->box        = box_empty;
    if (!cast_rounds(state, count, rays, ball))
        return;
    double margin = MARGIN * ball->radius;
    Box    first  = box_grow(rays->box, margin);
    search_beyond(state, box, count, margin, cells, rays);
    if (!is_inside(&rays->box, &first))
        grow_ball(rays, most, ball);
}

/* Finds the ball of what is hit.  In a box that is much too large a floor may be, and nothing else: then all is
   tried again, if that takes little time. */
static void find_ball(KrsState *state, Box box, Rays *rays, Cells *cells, Ball *ball)
{
    const Ball outer = *ball;
    rays->apart      = false;
    look_for_ball(state, box, rays, cells, ball);
    if (rays->seen_count >= FEWEST_SEEN || is_costly(state->scene, FEWEST_RAYS))
        return;
    rays->apart = true;
    *ball       = outer;
    look_for_ball(state, box, rays, cells, ball);
}

/* ---- the camera ---- */

/* The part of the height of the picture that is filled: by what is wide, by what is tall, and by
   the mean of both.  Pictures are wider than high, but may be square.  The eye comes no nearer than
   a part of the distance from which the ball fills the height, for things would look distorted from
   there. */
static const double WIDE = 0.95, TALL = 0.82, FILLED = 0.68, NEAREST = 0.65;

/* The default camera: where it is, and the axes of its picture. */
typedef struct DefaultCamera {
    double eye[3], target[3], to_eye[3], right[3], up[3];
    double away;  /* from the target to the eye */
    double slope; /* from the middle of the picture to its upper edge */
} DefaultCamera;

static void set_axes(DefaultCamera *camera)
{
    memcpy(camera->to_eye, (double[]){0.53, 0.37, 0.76}, sizeof camera->to_eye);
    normalize3(camera->to_eye);
    cross3((double[]){0, 1, 0}, camera->to_eye, camera->right);
    normalize3(camera->right);
    cross3(camera->to_eye, camera->right, camera->up);
}

/* Finds from where to where the points reach along an axis of the picture; 1 is half its height. */
static Range reach_along(const Rays *rays, const DefaultCamera *camera, const double axis[3])
{
    Range reach = {HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < rays->seen_count; i++) {
        double from[3];
        add_scaled3(from, rays->seen[i], -1, camera->target);
        double depth = camera->away - dot3(from, camera->to_eye);
        double at    = dot3(from, axis) / (fmax(depth, 1e-3 * camera->away) * camera->slope);
        reach        = (Range){fmin(reach.low, at), fmax(reach.high, at)};
    }
    return reach;
}

/* Moves the target to the middle of what is seen, and the eye to where that fills the picture, until
   both hardly change. */
static void fill_picture(const Rays *rays, DefaultCamera *camera)
{
    enum { ROUNDS_OF_FILLING = 12 };
    const double least = NEAREST * camera->away;
    for (int i = 0; i < ROUNDS_OF_FILLING; i++) {
        Range  across = reach_along(rays, camera, camera->right);
        Range  along  = reach_along(rays, camera, camera->up);
        double wide = 0.5 * width_of(across), tall = 0.5 * width_of(along);
        double unit = 0.5 * camera->away * camera->slope;
        add_scaled3(camera->target, camera->target, unit * (across.low + across.high),
                    camera->right);
        add_scaled3(camera->target, camera->target, unit * (along.low + along.high), camera->up);
        camera->away *= fmax(fmax(wide / WIDE, tall / TALL), sqrt(wide * tall) / FILLED);
        camera->away = fmax(camera->away, least);
    }
}

/* Places the camera where the ball fills the height; or, where enough is seen to tell, what is
   seen. */
static DefaultCamera place_camera(const Rays *rays, const Ball *ball, double fov)
{
    DefaultCamera camera = {.away  = ball->radius / real_sin(0.5 * fov),
                            .slope = real_tan(0.5 * fov)};
    set_axes(&camera);
    memcpy(camera.target, ball->centre, sizeof camera.target);
    if (rays->seen_count >= FEWEST_SEEN)
        fill_picture(rays, &camera);
    add_scaled3(camera.eye, camera.target, camera.away, camera.to_eye);
    return camera;
}

/* Finds eye and target of the default camera for the values of a state.  Its direction and field of
   view are fixed.  Without bounded components nothing is changed: then `found` is false. */
static KrsStatus find_camera(KrsState *state, DefaultCamera *camera, bool *found)
{
    KrsView    view;
    const Box *boxes = state_find_boxes(state);
    Box        box   = state_outer_box(state, boxes);
    Ball       ball  = ball_around(box);
    *found           = ball.radius > 0 && isfinite(ball.radius);
    if (!*found)
        return KRS_OK;
    Rays     *rays   = malloc(sizeof *rays);
    Cells    *cells  = malloc(sizeof *cells);
    KrsStatus status = rays && cells ? KRS_OK : KRS_OUT_OF_MEMORY;
    if (status == KRS_OK) {
        rays->boxes = boxes;
        rays->most  = state->ran + MAX_OPERATIONS;
        find_ball(state, box, rays, cells, &ball);
        state_view(state, 0, &view);
        *camera = place_camera(rays, &ball, view.camera.fov);
    }
    free(rays);
    free(cells);
    return status;
}

KrsStatus krs_state_fit_camera(KrsState *state)
{
    DefaultCamera camera;
    bool          found;
    if (!state->scene->framed)
        return KRS_OK;
    state->exact     = true;
    KrsStatus status = find_camera(state, &camera, &found);
    state->exact     = false;
    if (status == KRS_OK && found) {
        memcpy(state->framed_eye, camera.eye, sizeof camera.eye);
        memcpy(state->framed_target, camera.target, sizeof camera.target);
    }
    return status;
}

/* Frames the scene with the defaults of parameters. */
static KrsStatus frame_scene(KrsScene *scene)
{
    KrsState     *state;
    DefaultCamera camera;
    KrsStatus     status = state_new(scene, &state);
    if (status != KRS_OK)
        return status;
    state->exact = true;
    status       = find_camera(state, &camera, &scene->framed);
    if (status == KRS_OK && scene->framed) {
        memcpy(scene->framed_eye, camera.eye, sizeof camera.eye);
        memcpy(scene->framed_target, camera.target, sizeof camera.target);
    }
    state_free(state);
    return status;
}

KrsStatus pass_frame(Compilation *c)
{
    return c->scene->cameras[0].standing_in ? frame_scene(c->scene) : KRS_OK;
}

static void print_camera(const KrsScene *scene, size_t index, const KrsCamera *camera, Text *out)
{
    static const char *const projections[] = {[KRS_PERSPECTIVE]  = "perspective",
                                              [KRS_ORTHOGRAPHIC] = "orthographic",
                                              [KRS_PANORAMA]     = "panorama"};
    const char              *name          = scene->cameras[index].name;
    text_format(out, "camera %zu%s%s  %s", index + 1, name ? " " : "", name ? name : "",
                projections[camera->projection]);
    text_format(out, "  eye %.6g %.6g %.6g  target %.6g %.6g %.6g", camera->eye[0], camera->eye[1],
                camera->eye[2], camera->target[0], camera->target[1], camera->target[2]);
    text_format(out, "  fov %.6g  height %.6g%s\n", camera->fov, camera->height,
                scene->framed && index == 0 ? "  placed" : "");
}

void print_frame(Compilation *c, Text *out)
{
    KrsState *state;
    KrsView   view;
    if (state_new(c->scene, &state) != KRS_OK) {
        text_add(out, "no frame: out of memory\n");
        return;
    }
    for (size_t i = 0; i < c->scene->camera_count; i++)
        if (state_view(state, i, &view) == KRS_OK)
            print_camera(c->scene, i, &view.camera, out);
    state_free(state);
}

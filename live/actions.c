/*
 * actions.c: what mouse and keys do.
 */
#include "live/actions.h"

#include <GLFW/glfw3.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "krs/camera.h"
#include "live/saving.h"
#include "live/text/camera_text.h"
#include "live/text/text_edit.h"

/* The angle of a drag over the height of the window, and of a step. */
#define DRAG_ORBIT M_PI
#define STEP_ORBIT (M_PI / 24)
#define STEP_MOVE  0.05
/* The part of the distance that a step of the wheel leaves. */
#define WHEEL_FACTOR 0.88
/* Flying passes this part of the distance to the target in a second. */
#define FLY_SPEED 0.8
/* This part of the distance is shown around a point of a component without an end. */
#define NEAR_PART 0.1

static void changed(Viewing *viewing)
{
    viewing->moved          = true;
    viewing->camera_written = false;
    viewing_show(viewing);
}

static void orbit(Viewing *viewing, double right, double up)
{
    krs_camera_orbit(&viewing->view.camera, right, up);
    changed(viewing);
}

static void pan(Viewing *viewing, double right, double up)
{
    krs_camera_pan(&viewing->view.camera, right, up);
    changed(viewing);
}

/* ---- keys ---- */

static void act_frame(Viewing *viewing)
{
    double       low[3], high[3];
    const double aspect = viewing->view.height > 0
                              ? (double)viewing->view.width / viewing->view.height
                              : 1;
    if (!krs_state_box(viewing_state(viewing), low, high))
        return;
    krs_camera_fit(&viewing->view.camera, low, high, aspect);
    changed(viewing);
}

/* Frames the component, or what is around the point where it has no end. */
static void act_frame_part(Viewing *viewing)
{
    const Found  found  = viewing_find(viewing);
    View        *view   = &viewing->view;
    const double aspect = view->height > 0 ? (double)view->width / view->height : 1;
    double       low[3], high[3];
    if (!found.hit)
        return;
    if (!krs_state_component_box(viewing_state(viewing), found.component - 1, low, high))
        for (int i = 0; i < 3; i++) {
            low[i]  = found.position[i] - NEAR_PART * found.depth;
            high[i] = found.position[i] + NEAR_PART * found.depth;
        }
    krs_camera_fit(&view->camera, low, high, aspect);
    changed(viewing);
}

static void act_home(Viewing *viewing)
{
    krs_state_fit_camera(viewing_state(viewing));
    viewing_take_camera(viewing, viewing->camera);
}

static void act_next_camera(Viewing *viewing)
{
    const size_t count = krs_camera_count(version_scene(viewing->view.version));
    viewing_take_camera(viewing, (viewing->camera + 1) % count);
}

static void act_center(Viewing *viewing)
{
    const Found found = viewing_find(viewing);
    if (!found.hit)
        return;
    krs_camera_aim(&viewing->view.camera, found.position);
    changed(viewing);
}

static void focus_on(Viewing *viewing, const Found *found)
{
    KrsCamera *camera = &viewing->view.camera;
    camera->focus     = found->depth;
    if (camera->aperture > 0)
        viewing_notice(viewing, "the lens is focused at %.4g", camera->focus);
    else
        viewing_notice(viewing, "the lens is focused at %.4g; all is sharp while its aperture is 0",
                       camera->focus);
    changed(viewing);
}

static void act_focus(Viewing *viewing)
{
    const Found found = viewing_find(viewing);
    if (found.hit)
        focus_on(viewing, &found);
}

static void look_along(Viewing *viewing, double x, double y, double z)
{
    krs_camera_axis(&viewing->view.camera, (double[]){x, y, z});
    changed(viewing);
}

static void act_front(Viewing *viewing) { look_along(viewing, 0, 0, 1); }
static void act_back(Viewing *viewing) { look_along(viewing, 0, 0, -1); }
static void act_right(Viewing *viewing) { look_along(viewing, 1, 0, 0); }
static void act_left(Viewing *viewing) { look_along(viewing, -1, 0, 0); }
static void act_top(Viewing *viewing) { look_along(viewing, 0, 1, 0); }
static void act_bottom(Viewing *viewing) { look_along(viewing, 0, -1, 0); }

static void act_perspective(Viewing *viewing)
{
    krs_camera_toggle_perspective(&viewing->view.camera);
    changed(viewing);
}

static void act_orbit_left(Viewing *viewing) { orbit(viewing, -STEP_ORBIT, 0); }
static void act_orbit_right(Viewing *viewing) { orbit(viewing, STEP_ORBIT, 0); }
static void act_orbit_up(Viewing *viewing) { orbit(viewing, 0, STEP_ORBIT); }
static void act_orbit_down(Viewing *viewing) { orbit(viewing, 0, -STEP_ORBIT); }
static void act_move_left(Viewing *viewing) { pan(viewing, -STEP_MOVE, 0); }
static void act_move_right(Viewing *viewing) { pan(viewing, STEP_MOVE, 0); }
static void act_move_up(Viewing *viewing) { pan(viewing, 0, STEP_MOVE); }
static void act_move_down(Viewing *viewing) { pan(viewing, 0, -STEP_MOVE); }

static void act_nearer(Viewing *viewing)
{
    krs_camera_dolly(&viewing->view.camera, NULL, WHEEL_FACTOR);
    changed(viewing);
}

static void act_farther(Viewing *viewing)
{
    krs_camera_dolly(&viewing->view.camera, NULL, 1 / WHEEL_FACTOR);
    changed(viewing);
}

static void act_play(Viewing *viewing)
{
    viewing->playing   = !viewing->playing;
    viewing->played_at = viewing_now();
}

static void act_earlier(Viewing *viewing)
{
    viewing_set_time(viewing, viewing->view.time - 1 / viewing->options->fps);
}

static void act_later(Viewing *viewing)
{
    viewing_set_time(viewing, viewing->view.time + 1 / viewing->options->fps);
}

static void act_path(Viewing *viewing)
{
    viewing->view.integrator = viewing->view.integrator == KRS_INTEGRATOR_PATH
                                   ? KRS_INTEGRATOR_PREVIEW
                                   : KRS_INTEGRATOR_PATH;
    viewing_show(viewing);
}

static void act_reset(Viewing *viewing) { viewing_reset_values(viewing); }

static void act_undo(Viewing *viewing)
{
    viewing->undoing = history_undo(viewing->history, &viewing->view);
    if (viewing->undoing)
        changed(viewing);
}

static void act_redo(Viewing *viewing)
{
    viewing->undoing = history_redo(viewing->history, &viewing->view);
    if (viewing->undoing)
        changed(viewing);
}

static void act_copy_camera(Viewing *viewing)
{
    char *text = camera_text(&viewing->view.camera);
    if (text && viewing->window)
        window_copy(viewing->window, text);
    viewing_notice(viewing, viewing->window
                                ? "the camera is on the clipboard"
                                : "a terminal has no clipboard; Ctrl E writes it into the file");
    free(text);
}

/* Tells whether the text is in a file, or says that it is not. */
static bool is_writable(Viewing *viewing)
{
    if (viewing->options->supplied.text)
        viewing_notice(viewing, "the scene is in a pack, which nothing is written into");
    return !viewing->options->supplied.text;
}

/* Says what came of writing into the text.  False: nothing was written. */
static bool is_written(Viewing *viewing, KrsStatus status)
{
    if (status == KRS_BAD_ARGUMENT)
        viewing_notice(viewing, "the text is not the one that is shown: save it without mistakes");
    else if (status != KRS_OK)
        viewing_notice(viewing, "the file cannot be written");
    return status == KRS_OK;
}

/* Writes the camera into the text, which it follows again from then on. */
static void act_write_camera(Viewing *viewing)
{
    const KrsScene *scene  = version_scene(viewing->view.version);
    KrsStatus       status = KRS_BAD_ARGUMENT;
    KrsCamera       before;
    if (!is_writable(viewing))
        return;
    if (viewing->diagnostics.errors == 0 &&
        krs_state_camera(viewing->state, viewing->camera, &before) == KRS_OK)
        status = camera_text_write(scene, viewing->camera, &before, &viewing->view.camera,
                                   viewing->options->path);
    if (!is_written(viewing, status))
        return;
    viewing->camera_written = true;
    viewing_notice(viewing, "the camera is written");
}

static void act_write_values(Viewing *viewing)
{
    size_t          written;
    const KrsScene *scene  = version_scene(viewing->view.version);
    KrsStatus       status = KRS_BAD_ARGUMENT;
    if (!is_writable(viewing))
        return;
    if (viewing->diagnostics.errors == 0)
        status = write_defaults(scene, (const double(*)[4])viewing->view.values, &written);
    if (is_written(viewing, status))
        viewing_notice(viewing, "%zu value%s written", written, written == 1 ? "" : "s");
}

/* Opens the editor at the first mistake of the text; if there is none, at what is under the mouse. */
static void act_edit(Viewing *viewing)
{
    char                 place[300];
    const Found          found = viewing_find(viewing);
    const KrsDiagnostic *error = diagnostics_first_error(&viewing->diagnostics);
    if (!is_writable(viewing))
        return;
    if (error)
        diagnostic_location(error, place);
    if (error || (found.hit && viewing_place(viewing, found.component, place)))
        viewing_open_editor(viewing, place);
}

static void act_save(Viewing *viewing) { saving_keep_shot(viewing); }

static void act_save_file(Viewing *viewing) { saving_start_or_stop(viewing); }

static void act_shading(Viewing *viewing)
{
    viewing->view.shading = (ShadingMode)((viewing->view.shading + 1) % SHADING_COUNT);
    viewing_notice(viewing, "%s", shading_mode_names[viewing->view.shading]);
    viewing_show(viewing);
}

static void act_costs(Viewing *viewing)
{
    if (viewing->costing.busy)
        profiler_cancel(viewing->profiler);
    else if (viewing->costs.count > 0)
        viewing_drop_costs(viewing);
    else if (viewing->view.width > 0 && profiler_start(viewing->profiler, &viewing->view)) {
        viewing->costs_version = version_number(viewing->view.version);
        viewing->costs_view    = viewing->views;
    }
}

/* Measures the size of what is seen, for a scene without an end as well. */
static void measure_scene(Viewing *viewing)
{
    const KrsCamera *camera = &viewing->view.camera;
    double           low[3], high[3], sum = 0;
    const bool       bounded = krs_state_box(viewing_state(viewing), low, high);
    for (int i = 0; i < 3; i++)
        sum += bounded ? pow(high[i] - low[i], 2) : pow(camera->target[i] - camera->eye[i], 2);
    viewing->cut.size = fmax(sqrt(sum), 1e-9);
}

static void act_cut_plane(Viewing *viewing)
{
    Cut *cut = &viewing->cut;
    measure_scene(viewing);
    if (cut->plane)
        cut->plane = false;
    else
        cut_face(cut, &viewing->view.camera, viewing->view.camera.target);
    viewing_set_cut(viewing);
}

static void act_cut_ball(Viewing *viewing)
{
    Cut        *cut   = &viewing->cut;
    const Found found = viewing_find(viewing);
    measure_scene(viewing);
    cut->ball   = !cut->ball;
    cut->radius = 0.1 * cut->size;
    memcpy(cut->center, found.hit ? found.position : viewing->view.camera.target,
           sizeof cut->center);
    viewing_set_cut(viewing);
}

static void act_larger(Viewing *viewing)
{
    viewing->cut.radius *= 1.15;
    viewing_set_cut(viewing);
}

static void act_smaller(Viewing *viewing)
{
    viewing->cut.radius /= 1.15;
    viewing_set_cut(viewing);
}

static void act_numbers(Viewing *viewing) { viewing->numbers = !viewing->numbers; }

static void act_panels(Viewing *viewing) { viewing->panels = !viewing->panels; }

static void act_into_panel(Viewing *viewing)
{
    if (!viewing->window)
        return;
    viewing->panels = true;
    viewing->help   = false;
    window_navigate(viewing->window);
}

static void act_help(Viewing *viewing) { viewing->help = !viewing->help; }

static void act_quit(Viewing *viewing)
{
    viewing->ended = true;
    if (viewing->window)
        window_ask_to_close(viewing->window);
}

static void act_close(Viewing *viewing)
{
    if (viewing->help)
        viewing->help = false;
    else
        act_quit(viewing);
}

const Action actions[] = {
#define ACTION(id, key, modifiers, keys, does) {key, modifiers, keys, does, act_##id},
#include "live/actions.def"
#undef ACTION
};
const size_t action_count = sizeof actions / sizeof *actions;

void act_key(void *user, int key, int modifiers)
{
    Viewing  *viewing = user;
    const int counted = modifiers & (GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT);
    viewing->grounded = viewing->grounded || (modifiers & GLFW_MOD_CONTROL);
    if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9)
        key += GLFW_KEY_0 - GLFW_KEY_KP_0;
    if (key == GLFW_KEY_KP_ADD || key == GLFW_KEY_KP_SUBTRACT)
        key = key == GLFW_KEY_KP_ADD ? GLFW_KEY_EQUAL : GLFW_KEY_MINUS;
    if (viewing->help && (key == GLFW_KEY_UP || key == GLFW_KEY_DOWN)) {
        viewing->scrolled += key == GLFW_KEY_UP ? -1 : 1;
        return;
    }
    for (size_t i = 0; i < action_count; i++)
        if (actions[i].key == key && actions[i].modifiers == counted) {
            actions[i].act(viewing);
            return;
        }
}

/* ---- the mouse ---- */

void act_scroll(void *user, double steps)
{
    Viewing    *viewing = user;
    const Found found   = viewing_find(viewing);
    krs_camera_dolly(&viewing->view.camera, found.hit ? found.position : NULL,
                     pow(WHEEL_FACTOR, steps));
    changed(viewing);
}

void act_drag(void *user, int button, int modifiers, double right, double down)
{
    Viewing     *viewing = user;
    const double side    = viewing->view.height > 0 ? viewing->view.height : 1;
    const double x = right / side, y = down / side;
    if ((modifiers & GLFW_MOD_ALT) && (viewing->cut.ball || viewing->cut.plane)) {
        cut_drag(&viewing->cut, &viewing->view.camera, x, -y);
        viewing_set_cut(viewing);
    } else if (button == GLFW_MOUSE_BUTTON_MIDDLE ||
               (button == GLFW_MOUSE_BUTTON_LEFT && (modifiers & GLFW_MOD_SHIFT)))
        pan(viewing, x, -y);
    else if (button == GLFW_MOUSE_BUTTON_LEFT)
        orbit(viewing, -x * DRAG_ORBIT, y * DRAG_ORBIT);
    else {
        krs_camera_look(&viewing->view.camera, x * DRAG_ORBIT / 2, -y * DRAG_ORBIT / 2);
        changed(viewing);
    }
}

/* Edits what is clicked, or focuses on it. */
void act_click(void *user, int button, int modifiers)
{
    Viewing    *viewing = user;
    const Found found   = viewing_find(viewing);
    char        place[300];
    if (button != GLFW_MOUSE_BUTTON_LEFT || !found.hit)
        return;
    if ((modifiers & GLFW_MOD_CONTROL) && viewing_place(viewing, found.component, place))
        viewing_open_editor(viewing, place);
    else if (modifiers & GLFW_MOD_ALT)
        focus_on(viewing, &found);
}

/* ---- what goes on by itself ---- */

/* A terminal does not tell which keys are held: each press goes a step. */
bool act_fly_step(Viewing *viewing, int key)
{
    const double step  = 0.1;
    const double ahead = key == GLFW_KEY_W ? step : key == GLFW_KEY_S ? -step : 0;
    const double right = key == GLFW_KEY_D ? step : key == GLFW_KEY_A ? -step : 0;
    const double up    = key == GLFW_KEY_E ? step : key == GLFW_KEY_Q ? -step : 0;
    if (ahead == 0 && right == 0 && up == 0)
        return false;
    krs_camera_fly(&viewing->view.camera, ahead, right, up);
    changed(viewing);
    return true;
}

/* Returns -1, 0 or 1 by two keys that are held. */
static double held(const Viewing *viewing, int less, int more)
{
    if (!viewing->window)
        return 0;
    return (window_key_is_held(viewing->window, more) ? 1 : 0) -
           (window_key_is_held(viewing->window, less) ? 1 : 0);
}

static bool fly(Viewing *viewing, double now)
{
    const double seconds = fmin(now - viewing->flown_at, 0.1) * FLY_SPEED;
    const double ahead   = held(viewing, GLFW_KEY_S, GLFW_KEY_W);
    const double right   = held(viewing, GLFW_KEY_A, GLFW_KEY_D);
    const double up      = held(viewing, GLFW_KEY_Q, GLFW_KEY_E);
    const bool   any     = ahead != 0 || right != 0 || up != 0;
    viewing->flown_at    = now;
    viewing->grounded    = viewing->grounded && any;
    if (viewing->grounded || !any)
        return false;
    krs_camera_fly(&viewing->view.camera, ahead * seconds, right * seconds, up * seconds);
    changed(viewing);
    return true;
}

static void play(Viewing *viewing, double now)
{
    double time = viewing->view.time + now - viewing->played_at;
    if (viewing->loop > 0 && time > viewing->loop)
        time = fmod(time, viewing->loop);
    viewing->played_at = now;
    viewing_set_time(viewing, time);
}

bool act_run(Viewing *viewing)
{
    const double now    = viewing_now();
    const bool   flying = fly(viewing, now);
    if (viewing->playing)
        play(viewing, now);
    return flying || viewing->playing;
}

/*
 * panels.c: what stands over the picture.
 */
#include "live/panels.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "compiler/base/srgb.h"
#include "live/actions.h"
#include "live/window/gui.h"

#define PANEL_WIDTH 320
/* Less is no panel to work with. */
#define MIN_CONTROLS 120
/* Keys in the first column of the help, below the mouse. */
#define FIRST_KEYS 12

/* ---- parameters ---- */

static bool draw_color(const KrsParameter *parameter, double *value)
{
    double shown[3];
    for (int i = 0; i < 3; i++)
        shown[i] = srgb_of_linear(fmin(fmax(value[i], 0), 1));
    if (!gui_color(parameter->name, shown))
        return false;
    for (int i = 0; i < 3; i++)
        value[i] = fmin(fmax(linear_of_srgb(shown[i]), parameter->low[i]), parameter->high[i]);
    return true;
}

/* A number with both limits is a slider; others are dragged.  Angles are shown in degrees. */
static bool draw_numbers(const KrsParameter *parameter, double *value)
{
    const double unit = parameter->degrees ? 180 / M_PI : 1;
    const double low = parameter->low[0] * unit, high = parameter->high[0] * unit;
    const char  *format = parameter->degrees ? "%.5g\u00b0" : "%.5g";
    const bool   slides = parameter->components == 1 && isfinite(low) && isfinite(high);
    double       shown[4];
    for (uint32_t i = 0; i < parameter->components; i++)
        shown[i] = value[i] * unit;
    const double speed   = parameter->degrees ? 1 : fmax(fabs(shown[0]), 0.1) * 0.01;
    const bool   changed = slides ? gui_slider(parameter->name, shown, low, high, format)
                                  : gui_drag(parameter->name, shown, parameter->components, speed,
                                             low, high, format);
    for (uint32_t i = 0; changed && i < parameter->components; i++)
        value[i] = fmin(fmax(shown[i] / unit, parameter->low[i]), parameter->high[i]);
    return changed;
}

/* Tells whether a parameter is the whole numbers 0 and 1, as `in 0..2`. */
static bool is_switch(const KrsParameter *parameter)
{
    return parameter->whole && parameter->components == 1 && parameter->low[0] == 0 &&
           parameter->high[0] == 1;
}

static bool draw_switch(const KrsParameter *parameter, double *value)
{
    bool on = value[0] > 0.5;
    if (!gui_check(parameter->name, &on))
        return false;
    value[0] = on;
    return true;
}

/* Presets two in a line, each with a button that takes it out. */
static void draw_presets(Viewing *viewing)
{
    const Presets *presets = &viewing->presets;
    size_t         removed = presets->count;
    for (size_t i = 0; i < presets->count; i++) {
        char label[100];
        snprintf(label, sizeof label, "%s##preset%zu", presets->items[i].name, i);
        if (i % 2 > 0)
            gui_beside();
        if (gui_button(label, false))
            viewing_take_preset(viewing, &presets->items[i]);
        snprintf(label, sizeof label, "x##removed%zu", i);
        gui_beside();
        if (gui_button(label, false))
            removed = i;
        gui_tip("Forgets this preset.");
    }
    if (removed < presets->count)
        viewing_drop_preset(viewing, removed);
    if (gui_input("keep as", viewing->preset, sizeof viewing->preset) && viewing->preset[0]) {
        viewing_make_preset(viewing, viewing->preset);
        viewing->preset[0] = '\0';
    }
    gui_tip("A name and Enter keeps these values, in a file beside the scene.");
}

static void draw_parameters(Viewing *viewing)
{
    const KrsScene *scene = version_scene(viewing->view.version);
    for (size_t i = 0; i < krs_parameter_count(scene); i++) {
        KrsParameter parameter;
        double      *value = viewing->view.values[i];
        krs_parameter(scene, i, &parameter);
        const bool changed = parameter.color         ? draw_color(&parameter, value)
                             : is_switch(&parameter) ? draw_switch(&parameter, value)
                                                     : draw_numbers(&parameter, value);
        if (parameter.doc)
            gui_tip(parameter.doc);
        if (changed)
            viewing_show(viewing);
    }
}

static void draw_time(Viewing *viewing)
{
    double time = viewing->view.time, loop = viewing->loop;
    if (gui_button(viewing->playing ? "Pause" : "Play", viewing->playing))
        act_key(viewing, ' ', 0);
    gui_beside();
    if (gui_button("0 s", false))
        viewing_set_time(viewing, 0);
    if (gui_slider("time", &time, 0, fmax(loop, time), "%.2f s"))
        viewing_set_time(viewing, time);
    if (gui_drag("length", &loop, 1, 0.05, 0.1, 3600, "%.2f s"))
        viewing->loop = loop;
}

static void draw_camera(Viewing *viewing)
{
    const KrsScene *scene = version_scene(viewing->view.version);
    const size_t    count = krs_camera_count(scene);
    for (size_t i = 0; count > 1 && i < count; i++) {
        char        label[80];
        const char *name = krs_camera_name(scene, i);
        snprintf(label, sizeof label, "%s##camera%zu", name ? name : "camera", i);
        if (i > 0)
            gui_beside();
        if (gui_button(label, i == viewing->camera && !viewing->moved))
            viewing_take_camera(viewing, i);
    }
    if (gui_button("Frame all", false))
        act_key(viewing, 'F', 0);
    gui_beside();
    if (gui_button("Reset", false))
        viewing_take_camera(viewing, viewing->camera);
    gui_beside();
    if (gui_button("Write", false))
        act_key(viewing, 'E', ACT_CONTROL);
    gui_tip("Writes the camera into the text of the scene.");
    gui_beside();
    if (gui_button("Path", viewing->view.integrator == KRS_INTEGRATOR_PATH))
        act_key(viewing, 'P', 0);
}

/* Draws a whole number; 0 is written as what it stands for. */
static void draw_count(const char *label, uint32_t *count, uint32_t least, uint32_t most,
                       uint32_t stands_for)
{
    double shown = *count > 0 ? *count : stands_for;
    if (gui_drag(label, &shown, 1, 1, least, most, "%.0f"))
        *count = (uint32_t)lround(shown);
}

static void draw_save(Viewing *viewing)
{
    const SaverState         saving  = saver_state(viewing->saver);
    const View              *view    = &viewing->view;
    static const char *const forms[] = {"PNG", "EXR"};
    int                      kind = (int)viewing->save.kind, form = viewing->save.exr;
    if (gui_choice("what", &kind, save_names, SAVE_COUNT))
        viewing->save.kind = (SaveKind)kind;
    if (gui_choice("form", &form, forms, 2))
        viewing->save.exr = form == 1;
    draw_count("width", &viewing->save.width, 1, KRS_MAX_SIDE, view->width);
    draw_count("height", &viewing->save.height, 1, KRS_MAX_SIDE, view->height);
    draw_count("samples", &viewing->save.samples, 1, KRS_MAX_SAMPLES, view->samples);
    if (viewing->save.kind != SAVE_PICTURE)
        draw_count("frames", &viewing->save.frames, 1, 9999, 1);
    if (gui_button(saving.busy ? "Give up##save" : "Save##save", saving.busy))
        act_key(viewing, ACT_F12, ACT_CONTROL);
    if (saving.busy)
        gui_progress(saving.done);
}

static void draw_cut(Viewing *viewing)
{
    Cut *cut = &viewing->cut;
    if (gui_button("Cut", cut->plane))
        act_key(viewing, 'K', 0);
    gui_tip("Cuts away what is before the middle of the picture. Alt and the mouse move it.");
    gui_beside();
    if (gui_button("Ball", cut->ball))
        act_key(viewing, 'Z', 0);
    gui_tip("Cuts a ball out. Alt and the mouse move it.");
    if (cut->ball && gui_drag("radius", &cut->radius, 1, 0.001 * cut->size, 0, 1e9, "%.4g"))
        viewing_set_cut(viewing);
}

/*
 * The status stands at the left, the controls at the right, and what is under the mouse below them.
 * In a low window, where the controls need all of the height, that stands below the picture's left
 * edge.  In a narrow window all three stand one below the other.
 */
static GuiPlace place_of_controls(const Viewing *viewing)
{
    GuiPlace place = {.corner = GUI_TOP_RIGHT, .width = PANEL_WIDTH};
    if (window_has_room_beside(viewing->window))
        return place;
    const float left = gui_window_height() - viewing->heights.status;
    place.below      = left >= MIN_CONTROLS ? viewing->heights.status : 0;
    if (left - viewing->heights.found >= MIN_CONTROLS)
        place.spare = viewing->heights.found;
    return place;
}

/* Finds the place of a panel; false: there is none. */
static bool place_found(const Viewing *viewing, GuiPlace *place)
{
    const bool  beside = window_has_room_beside(viewing->window);
    const float left   = gui_window_height() - viewing->heights.controls;
    *place             = (GuiPlace){.corner = GUI_BOTTOM_RIGHT, .most = gui_window_width()};
    if (!beside)
        return gui_window_height() - viewing->heights.status - viewing->heights.found >=
               MIN_CONTROLS;
    if (left >= viewing->heights.found)
        return true;
    place->corner = GUI_BOTTOM_LEFT;
    place->below  = viewing->heights.diagnostics;
    place->most   = gui_window_width() - gui_panel_space(PANEL_WIDTH);
    return true;
}

static void draw_controls(Viewing *viewing)
{
    gui_panel("controls", place_of_controls(viewing), false);
    if (krs_parameter_count(version_scene(viewing->view.version)) > 0) {
        gui_heading("PARAMETERS");
        draw_parameters(viewing);
        if (gui_section("PRESETS"))
            draw_presets(viewing);
        gui_gap();
    }
    gui_heading("CAMERA");
    draw_camera(viewing);
    int shading = (int)viewing->view.shading;
    if (gui_choice("shows", &shading, shading_mode_names, SHADING_COUNT)) {
        viewing->view.shading = (ShadingMode)shading;
        viewing_show(viewing);
    }
    draw_cut(viewing);
    double aperture = viewing->view.camera.aperture;
    if (gui_drag("aperture", &aperture, 1, 0.002, 0, 1000, "%.4g")) {
        viewing->view.camera.aperture = aperture;
        viewing->moved                = true;
        viewing_show(viewing);
    }
    gui_tip("The radius of the lens. Alt and a click sets what is sharp.");
    gui_gap();
    gui_heading("TIME");
    draw_time(viewing);
    gui_gap();
    if (gui_section("SAVE"))
        draw_save(viewing);
    if (gui_drag("frame", &viewing->budget, 1, 0.5, 5, 1000, "%.0f ms"))
        painter_set_budget(viewing->painter, viewing->budget);
    gui_tip("How long a picture may take while something moves. More: finer, and slower.");
    if (gui_button("Keys and mouse: F1", false))
        viewing->help = true;
    viewing->heights.controls = gui_panel_end();
}

/* ---- what is going on ---- */

/* Returns what is shown where there are no shaders of what is wanted. */
static const char *words_for_shown(const Viewing *viewing, bool lanes)
{
    return lanes                     ? "lanes of the processor draw"
           : viewing->shot.width > 0 ? "this is what was before"
                                     : "there is nothing to see so far";
}

static void draw_doing(const Viewing *viewing)
{
    const PainterState *painting  = &viewing->painting;
    const Shot         *shot      = &viewing->shot;
    char                line[340] = "";
    const bool          lanes     = shot->stats.executor == KRS_EXECUTOR_LANES &&
                       shot->version == version_number(viewing->view.version);
    if (painting->compiling)
        snprintf(line, sizeof line, "compiling the shaders: %.0f %%; %s", 100 * painting->compiled,
                 words_for_shown(viewing, lanes));
    else if (painting->unbuilt[0])
        snprintf(line, sizeof line, "no shaders; %s: %s", words_for_shown(viewing, lanes),
                 painting->unbuilt);
    else if (painting->refused)
        snprintf(line, sizeof line, "the scene refuses these values");
    if (line[0])
        gui_text(lanes ? GUI_FAINT : GUI_WARNING, line);
    if (gui_navigates())
        gui_text(GUI_PLAIN, "keys go to the panel; Esc: back");
    if (painting->compiling && !lanes)
        gui_progress(painting->compiled);
}

static void draw_numbers_of_shot(const Viewing *viewing)
{
    const KrsRenderStats *stats = &viewing->shot.stats;
    char                  line[300];
    gui_text(GUI_FAINT, stats->device);
    for (int i = 0; i < KRS_PHASE_COUNT; i++) {
        snprintf(line, sizeof line, "%-10s %8.1f ms", krs_phase_names[i], stats->phase_ms[i]);
        gui_source(GUI_PLAIN, line);
    }
    snprintf(line, sizeof line,
             "on device  %8.1f ms\nby clock   %8.1f ms\n%llu rays by %s, %llu evaluations\n"
             "%.1f evaluations a ray, at most %u\n%.0f flops an evaluation, %.2f GFLOPS\n"
             "%llu unresolved, %.1f MB",
             stats->total_ms, stats->wall_ms, (unsigned long long)stats->rays,
             krs_executor_names[stats->executor], (unsigned long long)stats->evaluations,
             stats->evaluations_per_ray, stats->max_evaluations_per_ray,
             stats->flops_per_evaluation, stats->gflops, (unsigned long long)stats->unresolved,
             (double)stats->peak_memory_bytes / 1e6);
    gui_source(GUI_PLAIN, line);
}

static void draw_status(Viewing *viewing)
{
    char        line[200];
    const char *slash = strrchr(viewing->options->path, '/');
    const Shot *shot  = &viewing->shot;
    gui_panel("status", (GuiPlace){.corner = GUI_TOP_LEFT}, true);
    gui_text(GUI_STRONG, slash ? slash + 1 : viewing->options->path);
    if (shot->width > 0) {
        snprintf(line, sizeof line, "%u\u00d7%u   %u/%u   %.0f ms", shot->width, shot->height,
                 shot->samples, viewing->view.samples, shot->ms);
        gui_text(GUI_FAINT, line);
    }
    if (viewing_now() - viewing->noticed_at < 4 && viewing->notice[0])
        gui_text(GUI_PLAIN, viewing->notice);
    draw_doing(viewing);
    if (viewing->numbers)
        draw_numbers_of_shot(viewing);
    viewing->heights.status = gui_panel_end();
}

/* Draws the costliest parts below the status; a click opens the editor there. */
static void draw_costs(Viewing *viewing)
{
    const Costs *costs     = &viewing->costs;
    viewing->heights.costs = 0;
    if (!viewing->costing.busy && costs->count == 0)
        return;
    gui_panel("costs", (GuiPlace){.corner = GUI_TOP_LEFT, .below = viewing->heights.status}, false);
    if (viewing->costing.busy) {
        gui_text(GUI_PLAIN, "timing frames without each part; B: give up");
        gui_progress(viewing->costing.done);
    }
    for (size_t i = 0; i < costs->count; i++) {
        const CostLine *line = &costs->lines[i];
        char            id[32], words[440];
        if (i > 0 && !costs->lines[i - 1].place[0])
            gui_text(GUI_FAINT, "what several of these have in common");
        snprintf(id, sizeof id, "cost%zu", i);
        snprintf(words, sizeof words, "%s  %s", line->words, line->place);
        gui_swatch(line->color);
        gui_beside();
        if (gui_line(id, words, GUI_PLAIN) && line->place[0])
            viewing_open_editor(viewing, line->place);
    }
    if (costs->untimed > 0)
        gui_text(GUI_FAINT,
                 "There was no time for all parts: `krs info --cost --seconds N` has more.");
    viewing->heights.costs = gui_panel_end();
}

/* Draws what must be known even where there is no other panel. */
static void draw_notice(Viewing *viewing)
{
    gui_panel("notice", (GuiPlace){.corner = GUI_TOP_LEFT}, true);
    gui_text(GUI_PLAIN, viewing->notice);
    gui_panel_end();
}

/* Draws what is under the mouse. */
static void draw_found(Viewing *viewing)
{
    char         line[400], place[300];
    const Found  found = viewing_find(viewing);
    KrsComponent component;
    GuiPlace     there;
    if (gui_has_mouse() || !found.hit ||
        krs_component(version_scene(viewing->view.version), found.component - 1, &component) !=
            KRS_OK)
        return;
    if (!place_found(viewing, &there))
        return;
    gui_panel("found", there, true);
    const char *where = viewing_place(viewing, found.component, place);
    snprintf(line, sizeof line, "%s   %s   %s", component.name,
             viewing_shape(viewing, found.component), where ? where : "");
    gui_text(GUI_STRONG, line);
    snprintf(line, sizeof line, "%.4g, %.4g, %.4g", found.position[0], found.position[1],
             found.position[2]);
    gui_text(GUI_FAINT, line);
    /* This is a line of its own: the panel is to fit below that of the controls, beside the
       picture. */
    snprintf(line, sizeof line, "distance %.4g   level %u   instance %u", found.depth, found.level,
             found.instance);
    gui_text(GUI_FAINT, line);
    viewing->heights.found = gui_panel_end();
}

static void draw_diagnostics(Viewing *viewing)
{
    const Diagnostics *diagnostics = &viewing->diagnostics;
    viewing->heights.diagnostics   = 0;
    if (diagnostics->count == 0)
        return;
    gui_panel("diagnostics", (GuiPlace){.corner = GUI_BOTTOM_LEFT}, false);
    for (size_t i = 0; i < diagnostics->count; i++) {
        const KrsDiagnostic *diagnostic = &diagnostics->items[i];
        if (i > 0)
            gui_gap();
        char    label[32], place[300];
        GuiTone tone = diagnostic->error ? GUI_ERROR : diagnostic->note ? GUI_FAINT : GUI_WARNING;
        snprintf(label, sizeof label, "diagnostic%zu", i);
        diagnostic_location(diagnostic, place);
        if (gui_line(label, diagnostic->text, tone))
            viewing_open_editor(viewing, place);
    }
    if (diagnostics->errors > 0 && viewing->shot.width > 0)
        gui_text(GUI_FAINT, "The picture is that of the last text without a mistake.");
    viewing->heights.diagnostics = gui_panel_end();
}

/* Draws help in two columns, so that all of it is seen in a small window. */
static void draw_help(Viewing *viewing)
{
    gui_panel("help", (GuiPlace){.corner = GUI_CENTER}, false);
    gui_scroll(viewing->scrolled);
    viewing->scrolled = 0;
    gui_columns(2);
    gui_text(GUI_STRONG, "Mouse");
    gui_keys("left", "turn; with Shift move");
    gui_keys("middle", "move");
    gui_keys("right", "look around");
    gui_keys("Ctrl click", "open $KRS_EDITOR where the text has this");
    gui_keys("Alt click", "focus the lens on this");
    gui_keys("Alt drag", "move what is cut away");
    gui_keys("wheel", "nearer to what is under the mouse, or farther");
    gui_gap();
    gui_text(GUI_STRONG, "Keys");
    size_t rows = 0;
    gui_keys("W A S D E Q", "fly: ahead, left, back, right, up, down");
    for (size_t i = 0; i < action_count; i++)
        if (actions[i].keys) {
            gui_keys(actions[i].keys, actions[i].does);
            if (++rows == FIRST_KEYS)
                gui_next_column();
        }
    gui_columns_end();
    gui_panel_end();
}

double panels_width(const Viewing *viewing)
{
    return viewing->panels ? gui_panel_space(PANEL_WIDTH) : 0;
}

void panels_draw(Viewing *viewing)
{
    if (viewing->help) {
        draw_help(viewing);
        return;
    }
    if (viewing->panels && viewing->view.version) {
        draw_status(viewing);
        draw_costs(viewing);
        draw_controls(viewing);
        draw_found(viewing);
    } else if (viewing->reads_slowly) {
        draw_notice(viewing);
    }
    if (viewing->panels || viewing->diagnostics.errors > 0)
        draw_diagnostics(viewing);
}

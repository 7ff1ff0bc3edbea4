/*
 * window.c: a window with a picture, by GLFW and OpenGL.
 */
#include "live/window/window.h"

#include <GL/gl.h>
#include <GLFW/glfw3.h>
#include <fontconfig/fontconfig.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "live/window/gui.h"
#include "live/window/lost_display.h"

/* OpenGL 1.2; the header has what is older. */
#define CLAMP_TO_EDGE 0x812F
/* Farther than this, in pixels, a press is no click. */
#define CLICK_REACH 3
/* Points of the text, at 96 dots per inch. */
#define TEXT_SIZE 15.0F

struct Window {
    GLFWwindow  *glfw;
    WindowEvents events;
    GLuint       texture;
    bool         has_picture, linear;
    int          button;   /* that is held in the picture; -1: none */
    double       reserved; /* at the right, for panels */
    double       x, y;     /* of the mouse at the last event */
    double       moved;    /* pixels since the button was pressed */
    int          modifiers;
};

static const char *glfw_reason; /* why its last call failed */

static void note_reason(int code, const char *text)
{
    (void)code;
    static char kept[160];
    strncpy(kept, text, sizeof kept - 1);
    glfw_reason = kept;
}

/* ---- events ---- */

static void on_key(GLFWwindow *glfw, int key, int code, int action, int modifiers)
{
    Window *window = glfwGetWindowUserPointer(glfw);
    (void)code;
    if (gui_navigates()) {
        const bool leaves = key == GLFW_KEY_F2 || (key == GLFW_KEY_ESCAPE && !gui_is_inside());
        if (leaves && action == GLFW_PRESS)
            gui_navigate(NULL);
    } else if (action != GLFW_RELEASE && !gui_has_keys())
        window->events.key(window->events.user, key, modifiers);
}

static void on_scroll(GLFWwindow *glfw, double right, double up)
{
    Window *window = glfwGetWindowUserPointer(glfw);
    (void)right;
    if (!gui_has_mouse())
        window->events.scroll(window->events.user, up);
}

static void on_button(GLFWwindow *glfw, int button, int action, int modifiers)
{
    Window *window = glfwGetWindowUserPointer(glfw);
    if (action == GLFW_PRESS && window->button < 0 && !gui_has_mouse()) {
        window->button    = button;
        window->modifiers = modifiers;
        window->moved     = 0;
        glfwGetCursorPos(glfw, &window->x, &window->y);
    } else if (action == GLFW_RELEASE && button == window->button) {
        window->button = -1;
        if (window->moved <= CLICK_REACH)
            window->events.click(window->events.user, button, modifiers);
    }
}

static void on_move(GLFWwindow *glfw, double x, double y)
{
    Window *window = glfwGetWindowUserPointer(glfw);
    if (window->button >= 0) {
        window->moved += hypot(x - window->x, y - window->y);
        if (window->moved > CLICK_REACH)
            window->events.drag(window->events.user, window->button, window->modifiers,
                                x - window->x, y - window->y);
    }
    window->x = x;
    window->y = y;
}

/* ---- the window ---- */

/* Returns a font file for a family, which the caller frees; NULL: none is found. */
static char *find_font(const char *family)
{
    char      *path    = NULL;
    FcPattern *pattern = FcNameParse((const FcChar8 *)family);
    FcResult   result;
    FcChar8   *file;
    FcConfigSubstitute(NULL, pattern, FcMatchPattern);
    FcDefaultSubstitute(pattern);
    FcPattern *match = FcFontMatch(NULL, pattern, &result);
    if (match && FcPatternGetString(match, FC_FILE, 0, &file) == FcResultMatch)
        path = strdup((const char *)file);
    if (match)
        FcPatternDestroy(match);
    FcPatternDestroy(pattern);
    return path;
}

static void start_gui(GLFWwindow *glfw)
{
    float scale, unused;
    char *sans = find_font("sans-serif:scalable=true"),
         *mono = find_font("monospace:scalable=true");
    glfwGetWindowContentScale(glfw, &scale, &unused);
    gui_start(glfw, sans, mono, TEXT_SIZE * scale);
    free(sans);
    free(mono);
}

static GLFWwindow *create(const char *title, uint32_t width, uint32_t height)
{
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 0);
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "krs");
    glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "krs");
    return glfwCreateWindow((int)width, (int)height, title, NULL, NULL);
}

/* Handlers come before those of the panels, which call them. */
static void listen(Window *window)
{
    glfwSetWindowUserPointer(window->glfw, window);
    glfwSetKeyCallback(window->glfw, on_key);
    glfwSetScrollCallback(window->glfw, on_scroll);
    glfwSetMouseButtonCallback(window->glfw, on_button);
    glfwSetCursorPosCallback(window->glfw, on_move);
}

bool window_connect(const char **why)
{
    glfwSetErrorCallback(note_reason);
    if (glfwInit())
        return true;
    *why = glfw_reason ? glfw_reason : "it cannot draw";
    return false;
}

Window *window_open(const char *title, uint32_t width, uint32_t height, const WindowEvents *events,
                    WindowLost *lost, const char **why)
{
    Window *window = calloc(1, sizeof *window);
    *why           = "out of memory";
    if (!window)
        return NULL;
    window->events = *events;
    window->button = -1;
    if (window_connect(why))
        window->glfw = create(title, width, height);
    if (!window->glfw) {
        *why = glfw_reason ? glfw_reason : "it cannot draw";
        glfwTerminate();
        free(window);
        return NULL;
    }
    lost_display_watch(lost);
    glfwMakeContextCurrent(window->glfw);
    glfwSwapInterval(1);
    glGenTextures(1, &window->texture);
    listen(window);
    start_gui(window->glfw);
    return window;
}

void window_close(Window *window)
{
    if (!window)
        return;
    gui_stop();
    glfwDestroyWindow(window->glfw);
    glfwTerminate();
    free(window);
}

bool window_wait(Window *window, double seconds)
{
    if (seconds <= 0)
        glfwPollEvents();
    else if (isinf(seconds))
        glfwWaitEvents();
    else
        glfwWaitEventsTimeout(seconds);
    return !glfwWindowShouldClose(window->glfw);
}

void window_wake(void) { glfwPostEmptyEvent(); }

void window_ask_to_close(Window *window) { glfwSetWindowShouldClose(window->glfw, GLFW_TRUE); }

/* ---- frames ---- */

/* Sets the filter: coarse pictures are smoothed; whole ones are shown pixel by pixel. */
static void set_filter(Window *window, bool linear)
{
    const GLint filter = linear ? GL_LINEAR : GL_NEAREST;
    window->linear     = linear;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, CLAMP_TO_EDGE);
}

void window_set_picture(Window *window, const uint8_t *pixels, uint32_t width, uint32_t height)
{
    uint32_t shown_width, shown_height;
    window_size(window, &shown_width, &shown_height);
    glBindTexture(GL_TEXTURE_2D, window->texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, (GLsizei)width, (GLsizei)height, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, pixels);
    set_filter(window, width != shown_width || height != shown_height);
    window->has_picture = true;
}

void window_reserve(Window *window, double right) { window->reserved = right; }

/* Less is no picture to work with. */
enum { MIN_PICTURE = 256 };

bool window_has_room_beside(const Window *window)
{
    int width, height;
    glfwGetWindowSize(window->glfw, &width, &height);
    return width >= window->reserved + MIN_PICTURE;
}

/* Returns the part of the window's width that the picture has.  In a narrow window it has all, and
   lies behind what is to its right. */
static double part_of_picture(const Window *window)
{
    int width, height;
    glfwGetWindowSize(window->glfw, &width, &height);
    return window_has_room_beside(window) ? 1 - window->reserved / width : 1;
}

static void framebuffer_size(const Window *window, uint32_t *width, uint32_t *height)
{
    int w, h;
    glfwGetFramebufferSize(window->glfw, &w, &h);
    *width  = w < 0 ? 0 : (uint32_t)w;
    *height = h < 0 ? 0 : (uint32_t)h;
}

void window_begin(Window *window)
{
    uint32_t width, height;
    framebuffer_size(window, &width, &height);
    glViewport(0, 0, (GLsizei)width, (GLsizei)height);
    glClearColor(0.07F, 0.075F, 0.08F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    gui_begin();
    if (window->has_picture)
        gui_backdrop(window->texture, (float)part_of_picture(window));
}

void window_end(Window *window)
{
    gui_end();
    glfwSwapBuffers(window->glfw);
}

void window_size(const Window *window, uint32_t *width, uint32_t *height)
{
    framebuffer_size(window, width, height);
    *width = (uint32_t)(*width * part_of_picture(window));
    if (glfwGetWindowAttrib(window->glfw, GLFW_ICONIFIED))
        *width = *height = 0;
}

void window_mouse(const Window *window, double *x, double *y)
{
    int width, height;
    glfwGetCursorPos(window->glfw, x, y);
    glfwGetWindowSize(window->glfw, &width, &height);
    *x /= width > 0 ? width * part_of_picture(window) : 1;
    *y /= height > 0 ? height : 1;
}

bool window_key_is_held(const Window *window, int key)
{
    return !gui_has_keys() && !gui_navigates() && glfwGetKey(window->glfw, key) == GLFW_PRESS;
}

void window_navigate(Window *window)
{
    (void)window;
    gui_navigate("controls");
}

void window_copy(Window *window, const char *text) { glfwSetClipboardString(window->glfw, text); }

/*
 * gui.h: the bridge to Dear ImGui, which is C++.  Labels may end in `##` and what tells them apart.
 */
#ifndef KRS_GUI_H
#define KRS_GUI_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct GLFWwindow GLFWwindow;

/* Begins to draw panels in the window whose context is current.  Fonts are paths, or NULL for the
   built-in one; `size` is in pixels. */
void gui_start(GLFWwindow *window, const char *sans, const char *mono, float size);
void gui_stop(void);
void gui_begin(void); /* of a frame */
void gui_end(void);   /* and draw it */

/* Tells whether mouse or keys are used by a panel just now. */
bool gui_has_mouse(void);
bool gui_has_keys(void);
/* Keys go to the panel of this name; NULL: to none. */
void gui_navigate(const char *panel);
bool gui_navigates(void);
bool gui_is_inside(void); /* of an item of the panel, which Esc leaves first */

/* Draws a texture behind all panels, over this part of the window's width from the left. */
void gui_backdrop(unsigned texture, float part);

typedef enum GuiCorner {
    GUI_TOP_LEFT,
    GUI_TOP_RIGHT,
    GUI_BOTTOM_LEFT,
    GUI_BOTTOM_RIGHT,
    GUI_CENTER
} GuiCorner;

typedef enum GuiTone { GUI_PLAIN, GUI_FAINT, GUI_STRONG, GUI_WARNING, GUI_ERROR } GuiTone;

/* The place of a panel, which grows with what it has, until it scrolls. */
typedef struct GuiPlace {
    GuiCorner corner;
    float     below; /* pixels between the corner and the panel */
    float     spare; /* pixels that stay free beyond it */
    float     width; /* 0: as its text needs, */
    float     most;  /* and at most this, where lines are broken; 0: the window's */
} GuiPlace;

/* A quiet one takes neither mouse nor keys.  gui_panel_end returns what it takes of the height, with a
   margin. */
void  gui_panel(const char *name, GuiPlace place, bool quiet);
float gui_panel_end(void);
/* Returns what a panel of this width needs of the window's, with its margins. */
float gui_panel_space(float width);
/* Tells how wide and high the window is, but for the margins. */
float gui_window_width(void);
float gui_window_height(void);

void gui_text(GuiTone tone, const char *text);
void gui_source(GuiTone tone, const char *text); /* in the monospaced font */
void gui_tip(const char *text);                  /* of the last item, when the mouse is on it */
void gui_heading(const char *text);
bool gui_section(const char *label); /* a heading that opens and closes; whether it is open */
void gui_gap(void);
void gui_beside(void); /* the next item stands beside the last one */
bool gui_button(const char *label, bool on);
bool gui_line(const char *id, const char *text, GuiTone tone); /* lines that can be clicked */
void gui_swatch(const unsigned char color[3]);                 /* a square as high as a line */
bool gui_slider(const char *label, double *value, double low, double high, const char *format);
/* Changes numbers without limits, by dragging; `speed` is for a pixel. */
bool gui_drag(const char *label, double *values, size_t count, double speed, double low,
              double high, const char *format);
bool gui_check(const char *label, bool *on);
bool gui_color(const char *label, double rgb[3]); /* as the screen has it, each in [0, 1] */
bool gui_choice(const char *label, int *chosen, const char *const *names, size_t count);
bool gui_input(const char *label, char *text, size_t size);
void gui_progress(double done);                    /* a bar; `done` is from 0 to 1 */
void gui_keys(const char *keys, const char *does); /* a row of the help */
/* Begins columns side by side, each as wide as what it has; below each other in a narrow window. */
void gui_columns(int count);
void gui_next_column(void);
void gui_columns_end(void);
void gui_scroll(int lines); /* of the panel that is being drawn */

#ifdef __cplusplus
}
#endif
#endif

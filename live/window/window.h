/*
 * window.h: a window with a picture, and what the mouse and the keys do in it.
 */
#ifndef KRS_WINDOW_H
#define KRS_WINDOW_H

#include <stdbool.h>
#include <stdint.h>

typedef struct Window Window;

/* The callbacks for events; all are called in the thread of the window. */
typedef struct WindowEvents {
    void (*key)(void *user, int key, int modifiers);
    void (*scroll)(void *user, double steps);
    /* Pixels of the window since the last call, while a button is held. */
    void (*drag)(void *user, int button, int modifiers, double right, double down);
    /* A button was pressed and released without being moved. */
    void (*click)(void *user, int button, int modifiers);
    void *user;
} WindowEvents;

/* Called when the connection to the display is lost; does not return. */
typedef void WindowLost(void);

/* Connects to the display, which window_open does else: for who cannot do so later.  False: there is none; *why is one line
   about it. */
bool window_connect(const char **why);

/* Opens a window; NULL: there is no display, or none that can draw; *why is one line about it. */
Window *window_open(const char *title, uint32_t width, uint32_t height, const WindowEvents *events,
                    WindowLost *lost, const char **why);
void    window_close(Window *window);

/* Waits for something to happen, at most so long, and handles events.  False: it is to be closed. */
bool window_wait(Window *window, double seconds);
/* Ends a wait; for any thread. */
void window_wake(void);
void window_ask_to_close(Window *window);

/* These begin and end a frame: whatever gui.h has comes between the two. */
void window_begin(Window *window);
void window_end(Window *window);

/* Keeps so much of the window free, at its right; in the units of gui.h.  Not of a window
   in which little would be left for the picture. */
void window_reserve(Window *window, double right);
/* Tells whether the picture stands beside that; in a narrow window it lies behind. */
bool window_has_room_beside(const Window *window);
/* Sets the picture behind everything, stretched to the rest of the window; four bytes a pixel. */
void window_set_picture(Window *window, const uint8_t *pixels, uint32_t width, uint32_t height);
/* Finds the size of the picture in the window, in pixels of the screen; 0 when it is minimised. */
void window_size(const Window *window, uint32_t *width, uint32_t *height);
/* Finds where the mouse is, in parts of the picture's width and height from its top left. */
void window_mouse(const Window *window, double *x, double *y);
bool window_key_is_held(const Window *window, int key);
/* Keys go to the panel from now on, until F2 or Esc. */
void window_navigate(Window *window);
void window_copy(Window *window, const char *text); /* to the clipboard */

#endif

/*
 * terminal.h: a terminal with a picture, and the keys that are pressed in it.
 */
#ifndef KRS_TERMINAL_H
#define KRS_TERMINAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct Terminal Terminal;

/* Takes the terminal of standard input and output over.  NULL: there is none, or the program was built
   without libchafa; *why is one line about it. */
Terminal *terminal_open(const char **why);
/* Leaves it as it was. */
void terminal_close(Terminal *terminal);

/* Waits for a key, for terminal_wake, for a signal, or so many seconds. */
void terminal_wait(Terminal *terminal, double seconds);
/* Ends terminal_wait; any thread may call it. */
void terminal_wake(Terminal *terminal);
/* Takes the next key that was pressed, as a key and modifiers of GLFW; false: there is none, and
   *closed when nobody can press one any more. */
bool terminal_key(Terminal *terminal, int *key, int *modifiers, bool *closed);

/* Finds the pixels that it shows at once. */
void terminal_size(const Terminal *terminal, uint32_t *width, uint32_t *height);
/* Shows a picture over the whole terminal, four bytes a pixel, and lines below it; NULL pixels:
   none yet. */
void terminal_show(Terminal *terminal, const uint8_t *pixels, uint32_t width, uint32_t height,
                   const char *const *lines, size_t count);

#endif

/*
 * cells.h: pictures as characters of a terminal, by libchafa.
 */
#ifndef KRS_CELLS_H
#define KRS_CELLS_H

#include <stdbool.h>
#include <stdint.h>

/* Tells whether the program was built with libchafa. */
bool cells_exist(void);
/* Tells whether the terminal shows pixels, not characters alone. */
bool cells_have_pixels(void);
/* Returns what a terminal of so many columns and rows is to be sent, for free(); its cells have so
   many pixels each.  NULL: without memory. */
char *cells_print(const uint8_t *pixels, uint32_t width, uint32_t height, int columns, int rows,
                  int cell_width, int cell_height);

#endif

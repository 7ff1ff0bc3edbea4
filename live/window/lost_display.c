/*
 * lost_display.c: what happens when the X server goes away.
 *
 * Xlib hands nothing of the caller's to its handler, so a variable of the file has it.
 */
#include "live/window/lost_display.h"

#include <X11/Xlib.h>
#include <stddef.h>

static void (*when_lost)(void);

static int lose(Display *display)
{
    (void)display;
    when_lost();
    return 0;
}

void lost_display_watch(void (*lost)(void))
{
    when_lost = lost;
    if (lost)
        XSetIOErrorHandler(lose);
}

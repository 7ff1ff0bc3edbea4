/*
 * lost_display.h: what happens when the X server goes away.
 */
#ifndef KRS_LOST_DISPLAY_H
#define KRS_LOST_DISPLAY_H

/* Calls `lost`, which must not return, when the connection breaks; Xlib would end the process with a
   message of its own. */
void lost_display_watch(void (*lost)(void));

#endif

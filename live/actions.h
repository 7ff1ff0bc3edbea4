/*
 * actions.h: what mouse and keys do.
 */
#ifndef KRS_ACTIONS_H
#define KRS_ACTIONS_H

#include "live/viewing.h"

typedef struct Action {
    int         key, modifiers;
    const char *keys, *does; /* NULL: not in the help */
    void (*act)(Viewing *viewing);
} Action;
/* The numbers that act_key gets for a modifier, and for a key without a letter. */
#define ACT_CONTROL 2
#define ACT_F12     301
extern const Action actions[];
extern const size_t action_count;

void act_key(void *viewing, int key, int modifiers);
void act_scroll(void *viewing, double steps);
void act_drag(void *viewing, int button, int modifiers, double right, double down);
void act_click(void *viewing, int button, int modifiers);
/* Flies a step by one of the keys for it; false: it is another key. */
bool act_fly_step(Viewing *viewing, int key);
/* Moves on what is held or plays.  Whether anything does. */
bool act_run(Viewing *viewing);

#endif

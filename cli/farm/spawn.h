/*
 * spawn.h: runs this program once more.
 */
#ifndef KRS_FARM_SPAWN_H
#define KRS_FARM_SPAWN_H

#include "cli/shell/commands.h"

/* The words of a command line. */
typedef struct Words {
    char **items;
    size_t count, capacity;
} Words;

void spawn_begin(Arena *arena, Words *words, const char *command, const char *file);
void spawn_add(Arena *arena, Words *words, const char *word);
/* Runs `krs` with these words, and returns its status; what it says goes to the log, or to standard error if that is
   NULL.  It is asked to end as soon as this process is. */
int spawn_run(const Options *options, Words *words, const char *log);

#endif

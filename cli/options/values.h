/*
 * values.h: the values of options, from words.
 *
 * A reader consumes a whole word and is false when it cannot; what it was to set may have changed
 * then, as nobody goes on with wrong options.
 */
#ifndef KRS_VALUES_H
#define KRS_VALUES_H

#include "cli/options/options.h"

/* Numbers from `low` to `high`.  No blanks; of what is not whole also no "inf", "nan" and
   hexadecimal digits, as in a scene. */
bool read_whole(const char *word, uint64_t low, uint64_t high, uint64_t *value);
bool read_count(const char *word, uint32_t low, uint32_t high, uint32_t *value);
bool read_number(const char *word, double low, double high, double *value);

bool read_size(const char *word, KrsRenderOptions *how); /* "640x480" */
bool read_samples(Options *options, const char *word);   /* "16", or "0..63/256" to render */
bool read_tiles(const char *word, uint32_t tiles[2]);    /* "4x2" */
bool read_crop(const char *word, KrsWindow *crop);       /* "X,Y,WIDTH,HEIGHT" */
bool read_frames(Options *options, const char *word);    /* "1..24" */
bool read_setting(Options *options, const char *word);   /* "r=0.5", "at=[1,2,3]", "c=#rrggbb" */
bool read_zone(Options *options, const char *word);      /* "X,Y,Z,R", of which there is room */
bool read_within(const char *word, WithinBox *box);      /* "X,Y,Z,X,Y,Z" */
bool read_plane(const char *word, SectionPlane *plane);  /* "X,Y,Z,X,Y,Z" */
bool read_exit_map(Options *options, const char *word);  /* "71=33,75=99" */
bool read_limits(const char *word, Limits *limits);      /* "time=10,memory=1G" */
bool read_white_balance(const char *word, WhiteBalance *balance); /* "5500", "5500,10" */
bool read_aovs(const char *word, uint32_t *aovs);                 /* "all", "none", "Z,N" */

/* Reads an expression of the language without names of the scene: names of colours, `2 * pi`, `1,
   2, 3`.  Its mistake is said. */
bool read_expression(Arena *arena, const char *text, Setting *setting);

#endif

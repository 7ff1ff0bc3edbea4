/*
 * choices.h: the words that options take.
 */
#ifndef KRS_CHOICES_H
#define KRS_CHOICES_H

typedef struct Choice {
    const char *name;  /* "" and "default" cannot be asked for */
    const char *about; /* what it means; "": its option tells */
} Choice;

/* The last has no name. */
extern const Choice integrator_choices[], trace_choices[], schedule_choices[], components_choices[],
    executor_choices[], normals_choices[], shadows_choices[], starts_choices[], catcher_choices[],
    pixel_filter_choices[], stereo_choices[], specialize_choices[], early_outs_choices[],
    plane_choices[], tone_map_choices[], pass_choices[], on_off_choices[], on_choices[],
    when_choices[], diagnostics_choices[], json_choices[], untrusted_choices[], split_choices[],
    copies_choices[], language_choices[], export_choices[], unit_choices[], axis_choices[],
    exposure_choices[], caustics_choices[];

/* Returns the number of a word among the choices; -1: it is none of them. */
int find_choice(const char *word, const Choice *choices);

#endif

/*
 * picture.h: from a rendered frame to the files that were asked for.
 */
#ifndef KRS_CLI_PICTURE_H
#define KRS_CLI_PICTURE_H

#include "cli/shell/commands.h"
#include "cli/picture/light_groups.h"
#include "cli/picture/sample_sums.h"

typedef enum FileForm { FORM_UNKNOWN, FORM_EXR, FORM_PNG } FileForm;

/* Tells the form of a file by the ending of its name, in any case. */
FileForm file_form(const char *path);

/* Returns the AOVs (bits of KrsAov) that writing these forms takes. */
uint32_t picture_aovs(const Options *options, bool exr);

/* The texts that stand in the files beside the pixels. */
typedef struct PictureNotes {
    const KrsScene *scene;
    double          time;        /* of the scene */
    DisplayOptions  display;     /* for PNG */
    LightGroups     groups;      /* further channels for EXR, or none */
    SampleSums      sums;        /* likewise */
    double          noise_floor; /* of the AOV noise */
    float (*denoised)[4];        /* NULL: not wanted */
} PictureNotes;

/* Writes the pixels to standard output, as a PNG shows them: rows from the top, R G B, a byte each. */
KrsStatus picture_write_raw(const KrsPicture *picture, const PictureNotes *notes);

/* Writes the picture to a file in the form its name tells. */
KrsStatus picture_write(const Options *options, const KrsPicture *picture,
                        const PictureNotes *notes, const char *path);

#endif

/*
 * loader.h: reads the texts of a scene and of the files that it uses, from disk or from the caller.
 */
#ifndef KRS_LOADER_H
#define KRS_LOADER_H

#include <stdbool.h>
#include <stddef.h>

#include "compiler/base/disk.h"

/* A caller's function that returns the text of a file, or NULL.  The path is the one shown in
   diagnostics.  The caller owns the text. */
typedef const char *TextSupplier(void *user, const char *path, size_t *length);

/* A caller's function that returns the bytes of a font, and which of several in them is meant, or NULL.  The name is NULL
   where any font will do. */
typedef const char *FontSupplier(void *user, const char *name, size_t *length, int *face);

/* A caller's function that is told of each file before it is read. */
typedef void TextObserver(void *user, const char *path);

typedef struct Loader {
    TextSupplier *supplier; /* NULL: files are read from disk */
    void         *user;
    TextObserver *observer; /* may be NULL */
    void         *observer_user;
    FontSupplier *fonts; /* NULL: they are those of the system */
    void         *fonts_user;
    bool          confined; /* only files below the folder `root` may be read */
    int           root;     /* descriptor of that folder; -1 where it could not be opened */
    char         *scene;    /* the scene's path, simplified; paths of used files begin like it */
    char         *scene_folder; /* path from the root to its folder; NULL: it is not in there */
} Loader;

/* Sets all members but the caller's functions and what is handed to them.  `root` may be NULL: nothing is confined.  False when
   there is no memory. */
bool loader_open(Loader *loader, const char *root, const char *scene);
void loader_close(Loader *loader);
/* These return the text of a file that a scene uses, and of the scene itself, which is read from
   disk even where there is a supplier. */
Loaded loader_read(const Loader *loader, const char *path);
Loaded loader_read_scene(const Loader *loader, const char *path);

#endif

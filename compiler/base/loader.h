/*
 * loader.h: where the texts of a scene and of the files that it uses come from.
 */
#ifndef KRS_LOADER_H
#define KRS_LOADER_H

#include <stdbool.h>
#include <stddef.h>

/* A text by the path that it has in diagnostics, or NULL; the caller's, for as long as it says. */
typedef const char *TextSupplier(void *user, const char *path, size_t *length);

typedef struct Loader {
    TextSupplier *supplier; /* or NULL: files are read */
    void         *user;
    bool          confined; /* to the folder `root`; -1 where it could not be opened */
    int           root;
    char         *scene;  /* the scene's path, simplified, as those of files it uses begin */
    char         *inside; /* its folder, as seen from the root; NULL: outside of it */
} Loader;

typedef struct Loaded {
    const char *text; /* NULL: there is none, for that reason */
    size_t      length;
    const char *reason;  /* static */
    bool        outside; /* of the root */
    char       *owned;   /* to be freed when the text is no longer needed */
} Loaded;

/* Takes "." and "name/.." out of a path, in place. */
void path_simplify(char *path);
/* `root` NULL: nothing is confined.  False: no memory. */
bool loader_open(Loader *loader, const char *root, const char *scene);
void loader_close(Loader *loader);
/* The text of a file; the scene's own is read from disk, the others as the loader says. */
Loaded loader_read(const Loader *loader, const char *path);
Loaded loader_read_scene(const Loader *loader, const char *path);

#endif

/*
 * include.c: reads the files that a scene of POV-Ray includes.
 */
#include <stdlib.h>
#include <string.h>

#include "import/pov/reader.h"
#include "compiler/base/loader.h"
#include "compiler/base/paths.h"
#include "compiler/base/source.h"

enum { MAX_INCLUDED = 4 << 20 };

static const char *const folders[] = {"/usr/share/povray-3.7/include/",
                                      "/usr/share/povray/include/",
                                      "/usr/local/share/povray-3.7/include/"};

/* Reads a file beside the scene, by the rules for what may be read. */
static Loaded read_beside(const Import *import, const char *name)
{
    Text   path   = {.arena = import->arena};
    Loader loader = {0};
    if (name[0] != '/')
        text_add_bytes(&path, import->path, path_folder_length(import->path));
    text_add(&path, name);
    path_simplify(path.bytes);
    if (!loader_open(&loader, import->root, import->path))
        return (Loaded){.reason = "there is not enough memory"};
    Loaded loaded = loader_read(&loader, path.bytes);
    loader_close(&loader);
    return loaded;
}

/* Reads a file that is included; POV-Ray's own folders are outside of any root. */
static Loaded read_included(const Import *import, const char *name)
{
    Loaded loaded = read_beside(import, name);
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        if (loaded.text || import->root || name[0] == '/' || strstr(name, ".."))
            break;
        Text standard = {.arena = import->arena};
        text_format(&standard, "%s%s", folders[i], name);
        const Loaded found = disk_read(standard.bytes);
        if (found.text)
            loaded = found;
    }
    return loaded;
}

static bool refuse_included(Import *import, unsigned line, const char *name, const Loaded *loaded)
{
    if (loaded->outside)
        return import_refuse(import, line, "`%.60s` is not read: %s", name, loaded->reason);
    if (strcmp(name, "colors.inc") == 0)
        return true; /* its names are known */
    import_note(import, line, "`%.60s` is not read: %s%s", name, loaded->reason,
                import->root ? ", and an untrusted import reads nothing of POV-Ray's folders" : "");
    return true;
}

bool pov_read_included(Import *import, unsigned line, const char *name, const char **text)
{
    Loaded loaded = read_included(import, name);
    *text         = NULL;
    if (!loaded.text)
        return refuse_included(import, line, name, &loaded);
    if (loaded.length < MAX_INCLUDED && !memchr(loaded.text, '\0', loaded.length))
        *text = arena_copy_text(import->arena, loaded.text, loaded.length);
    free(loaded.owned);
    return *text || import_refuse(import, line, "`%.60s` is no text, or too long", name);
}

/*
 * svg.c: a scene that shows a drawing.
 *
 * The language reads drawings by itself (`svg`), so the scene names the file, and what changes there
 * changes the scene.
 */
#include "import/svg.h"

#include <stdlib.h>
#include <string.h>

#include "compiler/base/paths.h"

/* Adds the file as seen from the folder of the scene; where that is another one, from everywhere. */
static void add_file_name(const Import *import, Text *name)
{
    const char *output = import->output ? import->output : "";
    size_t      folder = path_folder_length(output), own = path_folder_length(import->path);
    if (folder == own && strncmp(output, import->path, own) == 0)
        text_add(name, import->path + own);
    else if (folder == 0)
        text_add(name, import->path);
    else {
        char *whole = realpath(import->path, NULL);
        text_add(name, whole ? whole : import->path);
        free(whole);
    }
}

/* Adds a text as a string of the language. */
static void add_string(Text *text, const char *string)
{
    text_add(text, "\"");
    for (; *string; string++) {
        if (*string == '"' || *string == '\\')
            text_add(text, "\\");
        text_add_bytes(text, string, 1);
    }
    text_add(text, "\"");
}

bool import_svg(Import *import)
{
    Text *scene = &import->scene, name = {.arena = import->arena};
    add_file_name(import, &name);
    text_format(scene, "// From %s: each shape stands out a little from those before it.\n\n",
                import->name);
    text_add(scene, "let parts = svg(");
    add_string(scene, name.bytes);
    text_add(scene, ", size: 4);\n"
                    "for i in 0..len(parts) {\n"
                    "    show parts[i].extrude(0.2 + 0.02 * i);\n"
                    "}\n");
    return true;
}

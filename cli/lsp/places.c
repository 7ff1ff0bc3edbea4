/*
 * places.c: URIs of editors and paths of files.
 */
#include "cli/lsp/server.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "compiler/base/embedded.h"
#include "krs/krs.h"

/* ---- URIs ---- */

static int digit_of(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    c = (char)(c | 32);
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

char *path_of_uri(const char *uri)
{
    static const char scheme[] = "file://";
    if (strncmp(uri, scheme, sizeof scheme - 1) != 0)
        return strdup(uri);
    const char *from = strchr(uri + sizeof scheme - 1, '/'); /* behind the name of the machine */
    char       *path = from ? strdup(from) : strdup(uri), *to = path;
    for (const char *at = path; at && *at; at++) {
        const int  high = *at == '%' ? digit_of(at[1]) : -1, low = high >= 0 ? digit_of(at[2]) : -1;
        const char byte = (char)(16 * high + low);
        if (low >= 0 && byte != '\0') {
            *to++ = byte;
            at += 2;
        } else
            *to++ = *at;
    }
    if (to)
        *to = '\0';
    return path;
}

/* Returns "file://" and a path, where all but letters, digits and a few signs are hexadecimal
   digits; for free(). */
static char *uri_of_path(const char *path)
{
    static const char plain[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
    char *uri = malloc(sizeof "file://" + 3 * strlen(path)), *to = uri;
    if (!uri)
        return NULL;
    to += sprintf(to, "file://");
    for (; *path; path++)
        if (strchr(plain, *path))
            *to++ = *path;
        else
            to += sprintf(to, "%%%02X", (unsigned char)*path);
    *to = '\0';
    return uri;
}

/* ---- the library ---- */

static bool make_folders(char *path)
{
    for (char *slash = strchr(path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash         = '\0';
        const bool bad = mkdir(path, 0777) != 0 && errno != EEXIST;
        *slash         = '/';
        if (bad)
            return false;
    }
    return true;
}

/* Writes a file that appears whole or not at all. */
static bool write_file(const char *path, const EmbeddedFile *file)
{
    char *temporary = NULL;
    if (asprintf(&temporary, "%s.%ld", path, (long)getpid()) < 0)
        return false;
    const int  to   = open(temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0444);
    const bool good = to >= 0 && write(to, file->text, file->length) == (ssize_t)file->length;
    if (to >= 0)
        close(to);
    const bool there = good && rename(temporary, path) == 0;
    if (!there)
        unlink(temporary);
    free(temporary);
    return there;
}

/* Returns the path of a file of the library, which is written where it is not there; for free(). */
static char *library_path(const Places *places, const char *name)
{
    const EmbeddedFile *file = embedded_find(library_files, name);
    char               *path = NULL;
    struct stat         about;
    if (!file || !places->folder ||
        asprintf(&path, "%s/library-%s/%s", places->folder, KRS_VERSION, name) < 0)
        return NULL;
    if ((stat(path, &about) == 0 && about.st_size == (off_t)file->length) ||
        (make_folders(path) && write_file(path, file)))
        return path;
    free(path);
    return NULL;
}

const char *place_uri(void *user, const char *path)
{
    static const char library[] = "library:";
    Places           *places    = user;
    free(places->uri);
    places->uri = NULL;
    if (strncmp(path, library, sizeof library - 1) == 0) {
        char *own   = library_path(places, path + sizeof library - 1);
        places->uri = own ? uri_of_path(own) : NULL;
        free(own);
    } else if (path[0] == '/')
        places->uri = uri_of_path(path);
    return places->uri;
}

/* ---- folders ---- */

static bool is_folder(const char *folder, const struct dirent *entry)
{
    struct stat about;
    char       *path = NULL;
    bool        is   = entry->d_type == DT_DIR;
    if (entry->d_type != DT_LNK && entry->d_type != DT_UNKNOWN)
        return is;
    if (asprintf(&path, "%s/%s", folder, entry->d_name) >= 0) {
        is = stat(path, &about) == 0 && S_ISDIR(about.st_mode);
        free(path);
    }
    return is;
}

const char *place_list(void *user, const char *folder)
{
    enum { MAX_NAMES = 1000 };
    Places *places = user;
    size_t  length = 0;
    free(places->names);
    places->names = NULL;
    DIR  *opened  = opendir(*folder ? folder : ".");
    FILE *out     = opened ? open_memstream(&places->names, &length) : NULL;
    int   count   = 0;
    for (const struct dirent *entry; out && count < MAX_NAMES && (entry = readdir(opened)) != NULL;)
        if (entry->d_name[0] != '.' && !strchr(entry->d_name, '\n')) {
            fprintf(out, "%s%s\n", entry->d_name, is_folder(folder, entry) ? "/" : "");
            count++;
        }
    if (out)
        fclose(out);
    if (opened)
        closedir(opened);
    return places->names;
}

void places_free(Places *places)
{
    free(places->uri);
    free(places->names);
}

/*
 * frames.c: the messages of a stream, each behind a header that says how long it is.
 */
#include "cli/lsp/server.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

enum { MAX_HEADER = 4096, MAX_MESSAGE = 128 << 20, READ_BYTES = 1 << 16 };

/* ---- reading ---- */

static bool make_room(Frames *f)
{
    if (f->start > 0) {
        memmove(f->bytes, f->bytes + f->start, f->end - f->start);
        f->end -= f->start;
        f->start = 0;
    }
    if (f->capacity - f->end >= READ_BYTES)
        return true;
    const size_t capacity = 2 * f->capacity + READ_BYTES;
    char        *bytes    = realloc(f->bytes, capacity);
    if (bytes) {
        f->bytes    = bytes;
        f->capacity = capacity;
    }
    return bytes != NULL;
}

bool frames_read(Frames *f, int file)
{
    if (!make_room(f))
        return false;
    ssize_t got;
    do
        got = read(file, f->bytes + f->end, READ_BYTES);
    while (got < 0 && errno == EINTR);
    if (got <= 0)
        return false;
    f->end += (size_t)got;
    return true;
}

/* Returns the length that a header gives, which ends at `end`; SIZE_MAX: none, or one that is too
   large. */
static size_t length_in(const char *header, const char *end)
{
    static const char name[] = "Content-Length:";
    size_t            length = SIZE_MAX;
    while (header < end) {
        const char *line = memchr(header, '\n', (size_t)(end - header));
        if ((size_t)(end - header) > sizeof name &&
            strncasecmp(header, name, sizeof name - 1) == 0) {
            const char *digit = header + sizeof name - 1;
            while (digit < end && (*digit == ' ' || *digit == '\t'))
                digit++;
            for (length = digit < end && *digit >= '0' && *digit <= '9' ? 0 : SIZE_MAX;
                 digit < end && *digit >= '0' && *digit <= '9' && length <= MAX_MESSAGE; digit++)
                length = 10 * length + (size_t)(*digit - '0');
        }
        header = line ? line + 1 : end;
    }
    return length <= MAX_MESSAGE ? length : SIZE_MAX;
}

/* Returns the place behind the empty line that ends a header, or NULL. */
static const char *end_of_header(const char *bytes, size_t length)
{
    for (const char *at = bytes; (at = memchr(at, '\n', length - (size_t)(at - bytes))) != NULL;
         at++) {
        const size_t left = length - (size_t)(at + 1 - bytes);
        if (left >= 1 && at[1] == '\n')
            return at + 2;
        if (left >= 2 && at[1] == '\r' && at[2] == '\n')
            return at + 3;
    }
    return NULL;
}

bool frames_next(Frames *f, const char **message, size_t *length)
{
    if (f->broken)
        return false;
    const char  *bytes = f->bytes + f->start;
    const size_t there = f->end - f->start;
    const char *body = there ? end_of_header(bytes, there < MAX_HEADER ? there : MAX_HEADER) : NULL;
    if (!body) {
        f->broken = there >= MAX_HEADER;
        return false;
    }
    *length = length_in(bytes, body);
    if (*length == SIZE_MAX) {
        f->broken = true;
        return false;
    }
    if (there - (size_t)(body - bytes) < *length)
        return false;
    *message = body;
    f->start += (size_t)(body - bytes) + *length;
    return true;
}

/* ---- writing ---- */

static bool write_all(int file, const char *bytes, size_t length)
{
    while (length > 0) {
        const ssize_t put = write(file, bytes, length);
        if (put < 0 && errno == EAGAIN) {
            struct pollfd ready = {file, POLLOUT, 0};
            poll(&ready, 1, -1);
        } else if (put < 0 && errno != EINTR)
            return false;
        bytes += put > 0 ? put : 0;
        length -= put > 0 ? (size_t)put : 0;
    }
    return true;
}

bool frame_write(int file, const char *message, size_t length)
{
    char      header[64];
    const int size = snprintf(header, sizeof header, "Content-Length: %zu\r\n\r\n", length);
    return write_all(file, header, (size_t)size) && write_all(file, message, length);
}

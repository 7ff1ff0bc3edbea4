/*
 * text_file.c: reads and writes whole files.
 */
#include "live/text/text_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "compiler/base/disk.h"
#include "compiler/base/source.h"
#include "runtime/writer/atomic.h"

bool text_file_read(const char *path, Bytes *bytes)
{
    struct stat about;
    const int   file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file >= 0 && fstat(file, &about) == 0 && S_ISREG(about.st_mode)) {
        const Loaded loaded = disk_read_open(file);
        bytes->text         = loaded.owned;
        bytes->length       = loaded.length;
    } else if (file >= 0)
        close(file);
    return bytes->text && bytes->length <= MAX_SOURCE_BYTES;
}

bool text_file_write(const char *path, const Bytes *bytes)
{
    OutputError error;
    return output_text(path, bytes->text, bytes->length, NULL, &error) == KRS_OK;
}

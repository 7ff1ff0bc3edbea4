/*
 * sheet.c: a file of results is written beside its name, and takes its place when it is complete.
 */
#include "bench/sheet.h"

#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

static const char folder[] = "bench/results";

static _Noreturn void cannot_write(const Sheet *sheet)
{
    fprintf(stderr, "%s: cannot write %s: %s\n", sheet->bench, sheet->path, strerror(errno));
    exit(1);
}

void device_slug(const char *device, char *slug, size_t size)
{
    size_t length = 0;
    for (; *device && *device != '(' && length + 1 < size; device++)
        if (isalnum((unsigned char)*device))
            slug[length++] = (char)tolower((unsigned char)*device);
        else if (length > 0 && slug[length - 1] != '-')
            slug[length++] = '-';
    while (length > 0 && slug[length - 1] == '-')
        length--;
    slug[length] = '\0';
    if (length == 0)
        snprintf(slug, size, "device");
}

void date_today(char *date, size_t size)
{
    time_t    now = time(NULL);
    struct tm parts;
    gmtime_r(&now, &parts);
    strftime(date, size, "%Y-%m-%d", &parts);
}

static void print_head(const Sheet *sheet, const char *date, const char *command,
                       const char *device)
{
    struct utsname names;
    const char    *revision = getenv("REVISION");
    double         load     = 0;
    uname(&names);
    sheet_print(sheet, "- date: %s\n- device: %s\n- processor: %ld cores, %s, %s %s\n", date,
                device, sysconf(_SC_NPROCESSORS_ONLN), names.machine, names.sysname, names.release);
    if (getloadavg(&load, 1) == 1)
        sheet_print(sheet, "- load before: %.2f\n", load);
    sheet_print(sheet, "- krs: %s, revision %s\n- command: %s\n\n", KRS_VERSION,
                revision ? revision : "unknown", command);
}

Sheet sheet_open(const char *bench, const char *title, const char *command,
                 const KrsRenderer *renderer, bool part)
{
    Sheet           sheet  = {.bench = bench};
    const KrsDevice device = krs_renderer_device(renderer);
    char            date[16], slug[64];
    date_today(date, sizeof date);
    device_slug(device.name, slug, sizeof slug);
    if (!part) {
        mkdir(folder, 0777); /* it may be there; if it cannot be made, opening tells */
        snprintf(sheet.path, sizeof sheet.path, "%s/%s-%s-%s.md", folder, date, bench, slug);
        snprintf(sheet.unfinished, sizeof sheet.unfinished, "%.120s.new", sheet.path);
        sheet.file = fopen(sheet.unfinished, "w");
        if (!sheet.file)
            cannot_write(&sheet);
    }
    sheet_print(&sheet, "# %s\n\n", title);
    print_head(&sheet, date, command, device.name);
    return sheet;
}

void sheet_print(const Sheet *sheet, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
    fflush(stdout);
    if (!sheet->file)
        return;
    va_start(arguments, format);
    vfprintf(sheet->file, format, arguments);
    va_end(arguments);
}

void sheet_close(Sheet *sheet)
{
    if (!sheet->file)
        return;
    bool failed = ferror(sheet->file);
    if (fclose(sheet->file) != 0 || failed || rename(sheet->unfinished, sheet->path) != 0)
        cannot_write(sheet);
    fprintf(stderr, "%s: wrote %s\n", sheet->bench, sheet->path);
    *sheet = (Sheet){0};
}

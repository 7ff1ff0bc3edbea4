/*
 * machine.c: processor, memory, system, driver, compiler, from where Linux keeps them.
 */
#include "bench/machine.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "bench/sheet.h"
#include "runtime/device/driver.h"

#ifdef __clang__
#define COMPILER "clang " __clang_version__
#else
#define COMPILER "gcc " __VERSION__
#endif

/* Returns the rest of the first line of a file that begins with `key`, without what `trimmed` has
   at its ends; "unknown" when there is none. */
static const char *find_line(Bench *bench, const char *path, const char *key, const char *trimmed)
{
    char  line[512];
    FILE *file  = fopen(path, "r");
    Text  found = {.arena = bench->arena};
    while (file && found.length == 0 && fgets(line, sizeof line, file)) {
        if (strncmp(line, key, strlen(key)) != 0)
            continue;
        const char *text = line + strlen(key);
        text += strspn(text, trimmed);
        size_t length = strlen(text);
        while (length > 0 && strchr(trimmed, text[length - 1]))
            length--;
        text_add_bytes(&found, text, length);
    }
    if (file)
        fclose(file);
    return found.length > 0 ? found.bytes : "unknown";
}

static void add_fact(Machine *machine, const char *name, const char *text)
{
    machine->facts[machine->count++] = (struct MachineFact){name, text};
}

static const char *describe_processor(Bench *bench)
{
    Text text = {.arena = bench->arena};
    text_format(&text, "%s, %ld cores", find_line(bench, "/proc/cpuinfo", "model name", " \t:\n"),
                sysconf(_SC_NPROCESSORS_ONLN));
    return text.bytes;
}

static const char *describe_memory(Bench *bench)
{
    Text text = {.arena = bench->arena};
    text_format(&text, "%.1f GiB",
                (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE) / (1 << 30));
    return text.bytes;
}

static const char *describe_system(Bench *bench)
{
    struct utsname names;
    uname(&names);
    Text text = {.arena = bench->arena};
    text_format(&text, "%s, %s %s %s", find_line(bench, "/etc/os-release", "PRETTY_NAME=", "\"\n"),
                names.sysname, names.release, names.machine);
    return text.bytes;
}

static const char *describe_driver(Bench *bench)
{
    VkPhysicalDeviceDriverProperties driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
    vkGetPhysicalDeviceProperties2(bench->gpu.driver->physical, &properties);
    uint32_t version = properties.properties.apiVersion;
    Text     text    = {.arena = bench->arena};
    text_format(&text, "%s %s, Vulkan %u.%u.%u", driver.driverName, driver.driverInfo,
                VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                VK_API_VERSION_PATCH(version));
    return text.bytes;
}

/* Returns how busy the machine was before: figures of a shared one tell less. */
static const char *describe_load(Bench *bench)
{
    double load = 0;
    Text   text = {.arena = bench->arena};
    if (getloadavg(&load, 1) == 1)
        text_format(&text, "%.2f", load);
    return text.length > 0 ? text.bytes : "unknown";
}

/* The target of make, with what was asked for beyond it. */
static const char *describe_command(Bench *bench)
{
    Text text = {.arena = bench->arena};
    text_format(&text, "%s, %u repeats", bench->quick ? "make bench-quick" : "make bench",
                bench->repeats);
    if (bench->only)
        text_format(&text, ", only %s", bench->only);
    return text.bytes;
}

static const char *make_slug(Bench *bench, const char *device)
{
    char slug[64];
    device_slug(device, slug, sizeof slug);
    return arena_copy_text(bench->arena, slug, strlen(slug));
}

void machine_describe(Bench *bench, Machine *machine)
{
    const char *device = bench->gpu.driver->properties.deviceName;
    *machine           = (Machine){.slug = make_slug(bench, device)};
    add_fact(machine, "device", device);
    add_fact(machine, "driver", describe_driver(bench));
    add_fact(machine, "processor", describe_processor(bench));
    add_fact(machine, "memory", describe_memory(bench));
    add_fact(machine, "system", describe_system(bench));
    add_fact(machine, "load before", describe_load(bench));
    add_fact(machine, "compiler", COMPILER);
    add_fact(machine, "krs", KRS_VERSION);
    add_fact(machine, "revision", bench->revision);
    add_fact(machine, "command", describe_command(bench));
}

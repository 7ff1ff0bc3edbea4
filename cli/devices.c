/*
 * devices.c: `krs devices`: the Vulkan devices, and the one a render would take.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/shell/supervise.h"
#include "compiler/base/json.h"

static const char *const kind_names[] = {[KRS_DEVICE_OTHER]      = "other",
                                         [KRS_DEVICE_CPU]        = "cpu",
                                         [KRS_DEVICE_VIRTUAL]    = "virtual",
                                         [KRS_DEVICE_INTEGRATED] = "integrated",
                                         [KRS_DEVICE_DISCRETE]   = "discrete"};

typedef struct Version {
    unsigned major, minor, patch;
} Version;

/* Takes a version apart as VK_API_VERSION_MAJOR and its kin do. */
static Version unpack(uint32_t packed)
{
    return (Version){packed >> 22 & 0x7f, packed >> 12 & 0x3ff, packed & 0xfff};
}

static void print_text(const KrsDevice *devices, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        Version version = unpack(devices[i].api_version);
        printf("%c %zu  %s (%s, Vulkan %u.%u.%u)%s\n", devices[i].preferred ? '*' : ' ', i,
               devices[i].name, kind_names[devices[i].kind], version.major, version.minor,
               version.patch, devices[i].usable ? "" : ", not usable");
    }
}

static void print_json(Arena *arena, const KrsDevice *devices, size_t count)
{
    Json json = {.text = {.arena = arena}, .spaced = true};
    json_open(&json, NULL, "{");
    json_open(&json, "devices", "[");
    for (size_t i = 0; i < count; i++) {
        Version version = unpack(devices[i].api_version);
        Text    vulkan  = {.arena = arena};
        text_format(&vulkan, "%u.%u.%u", version.major, version.minor, version.patch);
        json_open(&json, NULL, "{");
        json_whole(&json, "index", i);
        json_text(&json, "name", devices[i].name);
        json_text(&json, "kind", kind_names[devices[i].kind]);
        json_text(&json, "vulkan", vulkan.bytes);
        json_truth(&json, "usable", devices[i].usable);
        json_truth(&json, "preferred", devices[i].preferred);
        json_close(&json, "}");
    }
    json_close(&json, "]");
    json_close(&json, "}");
    puts(json.text.bytes);
}

KrsStatus command_devices(Options *options)
{
    size_t count = 0;
    stage_enter(STAGE_DEVICE);
    KrsStatus  status   = krs_devices(NULL, 0, &count);
    KrsDevice *devices  = arena_new_array(options->arena, KrsDevice, count + 1);
    size_t     capacity = count;
    if (status == KRS_OK)
        status = krs_devices(devices, capacity, &count);
    if (status == KRS_NO_DEVICE)
        say("no Vulkan device; a driver for the processor is in the package mesa-vulkan-drivers");
    if (status != KRS_OK)
        return say_status(status, "the list of devices");
    count = count < capacity ? count : capacity;
    if (options->json)
        print_json(options->arena, devices, count);
    else
        print_text(devices, count);
    return KRS_OK;
}

/* Returns the folder of caches.  The XDG Base Directory Specification treats a folder that is not
   absolute as missing. */
const char *cache_folder(const Options *options)
{
    if (options->cache)
        return strcmp(options->cache, "off") == 0 ? NULL : options->cache;
    Text        path   = {.arena = options->arena};
    const char *caches = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    if (caches && caches[0] == '/')
        text_format(&path, "%s/krs", caches);
    else if (home && home[0] == '/')
        text_format(&path, "%s/.cache/krs", home);
    else
        return NULL;
    return path.bytes;
}

/* The driver's time is no part of a deadline while it works. */
static void keep_alive(void *user)
{
    (void)user;
    stage_note_progress();
}

KrsRendererOptions renderer_options(const Options *options)
{
    const char *device = options->device ? options->device : getenv("KRS_DEVICE");
    return (KrsRendererOptions){.device     = device,
                                .cache      = cache_folder(options),
                                .early_outs = options->early_outs,
                                .working    = keep_alive,
                                .timeout    = DEVICE_TIMEOUT * options->deadline};
}

static KrsStatus begin(const KrsRendererOptions *with, KrsRenderer **renderer)
{
    stage_enter(STAGE_DEVICE);
    KrsStatus status = krs_renderer_new(with, renderer);
    stage_enter(STAGE_START);
    return status;
}

KrsStatus open_renderer_early(const Options *options, KrsRenderer **renderer)
{
    KrsRendererOptions with = renderer_options(options);
    with.prewarm            = true;
    return begin(&with, renderer);
}

KrsStatus opened_renderer(KrsStatus status, KrsRenderer **renderer)
{
    if (status == KRS_OK)
        return KRS_OK;
    say("%s", *renderer ? krs_renderer_message(*renderer) : "out of memory");
    krs_renderer_free(*renderer);
    *renderer = NULL;
    return status;
}

KrsStatus open_renderer(const Options *options, KrsRenderer **renderer)
{
    const KrsRendererOptions with = renderer_options(options);
    return opened_renderer(begin(&with, renderer), renderer);
}

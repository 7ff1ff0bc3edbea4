/*
 * colors.c: POV-Ray's colours, word by word, and the space that they are in.
 */
#include <math.h>
#include <string.h>

#include "import/pov/reader.h"

static const char *const color_words[] = {"color", "colour", "rgb",   "rgbf",  "rgbt",
                                          "rgbft", "srgb",   "srgbf", "srgbt", "srgbft"};
static const char *const channels[]    = {"red", "green", "blue", "filter", "transmit"};

bool pov_color_follows(PovReader *reader)
{
    for (size_t i = 0; i < sizeof color_words / sizeof *color_words; i++)
        if (word_is(&reader->words, color_words[i]))
            return true;
    for (size_t i = 0; i < sizeof channels / sizeof *channels; i++)
        if (word_is(&reader->words, channels[i]))
            return true;
    return pov_value_follows(reader);
}

static double linear(double s) { return s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4); }

double pov_light_of(const PovReader *reader, double channel)
{
    double gamma = reader->gamma;
    return gamma == 0 ? linear(channel) : pow(fmax(channel, 0), gamma);
}

/* Converts a channel from how it is shown. */
static double in_space_of_file(const PovReader *reader, double shown)
{
    double gamma = reader->gamma;
    return gamma == 0 ? shown : pow(linear(fmax(shown, 0)), 1 / gamma);
}

/* Puts the numbers behind a word for colours where they belong: of rgbt the fourth is
 * `transmit`. */
static void take_channels(const PovReader *reader, const char *word, const PovValue *found,
                          PovValue *color)
{
    bool     encoded = word[0] == 's', transmits = strchr(word, 't') && !strchr(word, 'f');
    int      count = (int)strlen(word) - (encoded ? 1 : 0);
    PovValue all   = *found;
    pov_promote(&all, count < 3 ? 3 : count);
    memset(color->v, 0, sizeof color->v);
    for (int i = 0; i < 5 && i < (found->count > count ? found->count : count); i++)
        color->v[transmits && i == 3 ? 4 : i] = encoded && i < 3
                                                    ? in_space_of_file(reader, all.v[i])
                                                    : all.v[i];
    color->count = 5;
}

static int find_word(const PovReader *reader, const char *const *words, int count)
{
    for (int i = 0; i < count; i++)
        if (word_is(&reader->words, words[i]))
            return i;
    return -1;
}

/* Reads words and numbers, one after the other, each of which changes what is known so far. */
bool pov_color(PovReader *reader, double color[5])
{
    WordReader *words = &reader->words;
    PovValue    value = {.count = 0}, found;
    int         word, channel;
    if (!pov_release(reader))
        return false;
    if (!word_accept(words, "color"))
        word_accept(words, "colour");
    for (;;) {
        word    = find_word(reader, color_words + 2, sizeof color_words / sizeof *color_words - 2);
        channel = find_word(reader, channels, 5);
        if (word >= 0) {
            const char *name = words->word.text;
            words_advance(words);
            if (!pov_value(reader, &found))
                return false;
            take_channels(reader, name, &found, &value);
        } else if (channel >= 0) {
            words_advance(words);
            if (!pov_number(reader, &value.v[channel]))
                return false;
            value.count = 5;
        } else if (value.count == 0) {
            if (!pov_value(reader, &value))
                return false;
            pov_promote(&value, 3);
            value.count = value.count > 3 ? value.count : 3;
        } else {
            break;
        }
    }
    for (int i = 0; i < 5; i++)
        color[i] = i < value.count || value.count == 5 ? fmax(value.v[i], 0) : 0;
    return true;
}

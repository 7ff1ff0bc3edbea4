/*
 * colors.c: POV-Ray's colours, word by word, and the space that they are in.
 */
#include <math.h>
#include <string.h>

#include "compiler/base/srgb.h"
#include "import/pov/reader.h"

static const char *const color_words[] = {"rgb",  "rgbf",  "rgbt",  "rgbft",
                                          "srgb", "srgbf", "srgbt", "srgbft"};
static const char *const channels[]    = {"red", "green", "blue", "filter", "transmit"};

bool pov_color_follows(PovReader *reader)
{
    const WordReader *words = &reader->words;
    return word_is(words, "color") || word_is(words, "colour") || word_among(words, color_words) ||
           word_among(words, channels) || pov_value_follows(reader);
}

double pov_light_of(const PovReader *reader, double channel)
{
    double gamma = reader->gamma;
    return gamma == 0 ? linear_of_srgb(channel) : pow(fmax(channel, 0), gamma);
}

/* Converts a channel from how it is shown. */
static double in_space_of_file(const PovReader *reader, double shown)
{
    double gamma = reader->gamma;
    return gamma == 0 ? shown : pow(linear_of_srgb(fmax(shown, 0)), 1 / gamma);
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

/* Reads words and numbers, one after the other, each of which changes what is known so far. */
bool pov_color(PovReader *reader, double color[5])
{
    WordReader *words = &reader->words;
    PovValue    value = {.count = 0}, found;
    int         channel;
    if (!pov_release(reader))
        return false;
    if (!word_accept(words, "color"))
        word_accept(words, "colour");
    for (;;) {
        channel = word_index(words, channels, 5);
        if (word_among(words, color_words)) {
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

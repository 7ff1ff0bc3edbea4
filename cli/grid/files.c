/*
 * files.c: files that have all samples, row after row: NumPy's, NIfTI-1, KTX 2.0 and VTK's images.
 *
 * Formats differ in what stands before and behind the samples, and in how their numbers are dealt out to arrays.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "cli/grid/gridding.h"

enum { SIDE = KRS_BRICK_SIDE, MAX_ARRAYS = 5, MAX_NUMBERS = 5, MAX_HEADER = 4096 };

/* An array has some numbers for each sample, of 2 or 4 bytes each: the value, a part of the colour, the material as a
   whole number or as another. */
typedef enum GridNumber { VALUE, RED, GREEN, BLUE, MATERIAL, MATERIAL_FLOAT } GridNumber;

typedef struct GridArray {
    GridNumber numbers[MAX_NUMBERS];
    size_t     count;
    uint64_t   offset; /* of its first byte in the file */
} GridArray;

typedef struct GridRows {
    GridArray      arrays[MAX_ARRAYS];
    size_t         array_count;
    unsigned char *row; /* of the bricks of a row: its numbers of one array, x first */
    float         *values;
    float (*colors)[3];
    uint32_t   *materials;
    const char *behind; /* what the file ends with, or NULL */
} GridRows;

const char *grid_name(const GridSheet *sheet) { return sheet->fog ? "density" : "distance"; }

size_t grid_sample_bytes(const GridSheet *sheet)
{
    return sizeof(float) * (size_t)(1 + (sheet->color ? 3 : 0) + (sheet->material ? 1 : 0));
}

/* ---- halves ---- */

static const float LARGEST_HALF = 65504;

static uint32_t bits_of(float number)
{
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    return bits;
}

uint16_t half_bits(float number)
{
    enum { BIAS = 112, FEWER = 13, LEAST = 0x38800000 }; /* the least normal half, as a float */
    const uint32_t sign = bits_of(number) >> 31 << 15;
    const float    size = fabsf(number) < LARGEST_HALF ? fabsf(number) : LARGEST_HALF;
    const uint32_t bits = bits_of(size);
    uint32_t half = bits >= LEAST ? (bits >> FEWER) - (BIAS << 10) : (uint32_t)(size * 0x1p24f);
    if (half == 0 && number < 0)
        half = 1;
    return (uint16_t)(sign | half);
}

float half_value(float number)
{
    const uint16_t bits  = half_bits(number);
    const uint32_t whole = bits & 0x7FFF, power = whole >> 10;
    const float    size = power > 0 ? ldexpf((float)((whole & 0x3FF) | 0x400), (int)power - 25)
                                    : (float)whole * 0x1p-24f;
    return bits >> 15 ? -size : size;
}

/* ---- rows ---- */

static uint64_t sample_total(const GridSheet *sheet)
{
    return (uint64_t)sheet->shape.count[0] * sheet->shape.count[1] * sheet->shape.count[2];
}

static size_t number_bytes(const GridSheet *sheet, GridNumber number)
{
    return sheet->half && number != MATERIAL ? 2 : 4;
}

/* Returns the bytes of a sample. */
static size_t array_step(const GridSheet *sheet, const GridArray *array)
{
    size_t bytes = 0;
    for (size_t k = 0; k < array->count; k++)
        bytes += number_bytes(sheet, array->numbers[k]);
    return bytes;
}

static uint64_t array_bytes(const GridSheet *sheet, const GridArray *array)
{
    return array_step(sheet, array) * sample_total(sheet);
}

static size_t row_samples(const GridSheet *sheet) { return sheet->shape.count[0] * SIDE * SIDE; }

static GridRows *new_rows(GridFile *file)
{
    const GridSheet *sheet = file->sheet;
    GridRows        *rows  = arena_new(file->arena, GridRows);
    size_t           all   = row_samples(sheet);
    rows->row              = arena_alloc(file->arena, all, 4 * MAX_NUMBERS);
    rows->values           = arena_new_array(file->arena, float, all);
    rows->colors           = arena_alloc(file->arena, all, sizeof *rows->colors);
    rows->materials        = arena_new_array(file->arena, uint32_t, all);
    file->own              = rows;
    return rows;
}

static GridArray *add_array(GridRows *rows, size_t count, ...)
{
    GridArray *array = &rows->arrays[rows->array_count++];
    va_list    numbers;
    va_start(numbers, count);
    for (size_t i = 0; i < count; i++)
        array->numbers[array->count++] = va_arg(numbers, GridNumber);
    va_end(numbers);
    return array;
}

static void put_number(const GridRows *rows, GridNumber number, bool half, size_t sample,
                       unsigned char *to)
{
    float part;
    switch (number) {
    case MATERIAL: memcpy(to, &rows->materials[sample], 4); return;
    case MATERIAL_FLOAT: part = (float)rows->materials[sample]; break;
    case VALUE: part = rows->values[sample]; break;
    default: part = rows->colors[sample][number - RED];
    }
    const uint16_t bits = half ? half_bits(part) : 0;
    if (half)
        memcpy(to, &bits, 2);
    else
        memcpy(to, &part, 4);
}

/* Writes the part of a row of bricks that is in one layer, for one array: rows of samples that
   follow each other. */
static bool write_layer(GridFile *file, const GridArray *array, const size_t at[3], size_t layer)
{
    const GridRows *rows    = file->own;
    const size_t   *count   = file->sheet->shape.count;
    size_t          lines   = count[1] - at[1] < SIDE ? count[1] - at[1] : SIDE;
    size_t          samples = lines * count[0], bytes = array_step(file->sheet, array);
    unsigned char  *to = rows->row;
    for (size_t i = 0; i < samples; i++)
        for (size_t k = 0; k < array->count; k++) {
            put_number(rows, array->numbers[k], file->sheet->half, layer * SIDE * count[0] + i, to);
            to += number_bytes(file->sheet, array->numbers[k]);
        }
    uint64_t first = ((uint64_t)(at[2] + layer) * count[1] + at[1]) * count[0];
    return output_write(file->file, rows->row, samples * bytes, array->offset + first * bytes);
}

static bool write_row(GridFile *file, const size_t at[3])
{
    const GridRows *rows   = file->own;
    size_t          behind = file->sheet->shape.count[2] - at[2];
    for (size_t a = 0; a < rows->array_count; a++)
        for (size_t layer = 0; layer < SIDE && layer < behind; layer++)
            if (!write_layer(file, &rows->arrays[a], at, layer))
                return false;
    return true;
}

static bool add_to_row(GridFile *file, const KrsGridBrick *brick)
{
    GridRows    *rows = file->own;
    const size_t all = file->sheet->shape.count[0], left = all - brick->at[0];
    for (size_t i = 0; i < KRS_BRICK_SAMPLES; i++) {
        size_t to = i / SIDE * all + brick->at[0] + i % SIDE;
        if (i % SIDE >= left)
            continue;
        rows->values[to] = brick->values[i];
        if (brick->colors)
            memcpy(rows->colors[to], brick->colors[i], sizeof rows->colors[to]);
        if (brick->materials)
            rows->materials[to] = brick->materials[i];
    }
    return left > SIDE || write_row(file, brick->at);
}

static bool end_rows(GridFile *file)
{
    const GridRows *rows = file->own;
    return !rows->behind || output_append(file->file, rows->behind, strlen(rows->behind));
}

/* Arrays follow each other from there on; `between` bytes are before each. */
static void place_arrays(const GridFile *file, uint64_t offset, uint64_t between)
{
    GridRows *rows = file->own;
    for (size_t i = 0; i < rows->array_count; i++) {
        offset += between;
        rows->arrays[i].offset = offset;
        offset += array_bytes(file->sheet, &rows->arrays[i]);
    }
}

static double place_of(const KrsGridShape *shape, int axis, double index)
{
    return ((double)shape->first[axis] + index) * shape->cell;
}

/* ---- NumPy ---- */

/* Writes the head of NPY version 1.0: an array of numbers, or of records where there is more than
   the values. */
static bool begin_npy(GridFile *file)
{
    const GridSheet *sheet = file->sheet;
    const size_t    *count = sheet->shape.count;
    GridRows        *rows  = new_rows(file);
    GridArray       *array = add_array(rows, 1, VALUE);
    char             text[MAX_HEADER], type[256];
    const int        bytes = (int)number_bytes(sheet, VALUE);
    enum { BEFORE = 10, ALIGNED = 64 };
    snprintf(type, sizeof type, "'<f%d'", bytes);
    if (sheet->color || sheet->material)
        snprintf(type, sizeof type, "[('%s', '<f%d')%s%s]", grid_name(sheet), bytes,
                 sheet->color && bytes == 2 ? ", ('color', '<f2', (3,))"
                 : sheet->color             ? ", ('color', '<f4', (3,))"
                                            : "",
                 sheet->material ? ", ('material', '<u4')" : "");
    for (GridNumber k = RED; sheet->color && k <= BLUE; k++)
        array->numbers[array->count++] = k;
    if (sheet->material)
        array->numbers[array->count++] = MATERIAL;
    int length = snprintf(text + BEFORE, sizeof text - BEFORE,
                          "{'descr': %s, 'fortran_order': False, 'shape': (%zu, %zu, %zu), }", type,
                          count[2], count[1], count[0]);
    int all    = (BEFORE + length + ALIGNED) / ALIGNED * ALIGNED;
    memset(text + BEFORE + length, ' ', (size_t)(all - BEFORE - length));
    text[all - 1] = '\n';
    memcpy(text, "\x93NUMPY\x01\x00", 8);
    text[8] = (char)((all - BEFORE) % 256);
    text[9] = (char)((all - BEFORE) / 256);
    place_arrays(file, (uint64_t)all, 0);
    return output_append(file->file, text, (size_t)all);
}

/* ---- NIfTI-1 ---- */

static void put_short(unsigned char *header, size_t at, int16_t number)
{
    memcpy(header + at, &number, sizeof number);
}

static void put_int(unsigned char *header, size_t at, uint32_t number)
{
    memcpy(header + at, &number, sizeof number);
}

static void put_long(unsigned char *header, size_t at, uint64_t number)
{
    memcpy(header + at, &number, sizeof number);
}

static void put_float(unsigned char *header, size_t at, double number)
{
    float single = (float)number;
    memcpy(header + at, &single, sizeof single);
}

/* Begins a file in millimetres.  Its volumes are the values, and behind them red, green, blue and
   the material. */
static bool begin_nii(GridFile *file)
{
    enum { HEADER = 352, FLOAT32 = 16, MILLIMETRES = 2, SCANNER = 1 };
    const GridSheet *sheet          = file->sheet;
    const double     scale          = 1000 * sheet->metres;
    unsigned char    header[HEADER] = {0};
    GridRows        *rows           = new_rows(file);
    add_array(rows, 1, VALUE);
    for (GridNumber k = RED; sheet->color && k <= BLUE; k++)
        add_array(rows, 1, k);
    if (sheet->material)
        add_array(rows, 1, MATERIAL_FLOAT);
    put_int(header, 0, 348);
    put_short(header, 40, rows->array_count > 1 ? 4 : 3);
    put_float(header, 76, 1);
    for (size_t k = 0; k < 7; k++) {
        size_t count = k < 3 ? sheet->shape.count[k] : k == 3 ? rows->array_count : 1;
        put_short(header, 42 + 2 * k, (int16_t)count);
        put_float(header, 80 + 4 * k, k < 3 ? scale * sheet->shape.cell : 1);
    }
    put_short(header, 70, FLOAT32);
    put_short(header, 72, 32);
    put_float(header, 108, HEADER);
    put_float(header, 112, 1);
    header[123] = MILLIMETRES;
    snprintf((char *)header + 148, 80, "krs %s", KRS_VERSION);
    put_short(header, 252, SCANNER);
    put_short(header, 254, SCANNER);
    for (int k = 0; k < 3; k++) {
        double origin = scale * place_of(&sheet->shape, k, 0);
        put_float(header, 268 + 4 * (size_t)k, origin);
        put_float(header, 280 + 20 * (size_t)k, scale * sheet->shape.cell);
        put_float(header, 292 + 16 * (size_t)k, origin);
    }
    snprintf((char *)header + 328, 16, "%s", grid_name(sheet));
    memcpy(header + 344, "n+1", 4);
    place_arrays(file, HEADER, 0);
    return output_append(file->file, header, HEADER);
}

/* ---- KTX 2.0 ---- */

static size_t put_key(unsigned char *to, const char *key, const char *value)
{
    size_t length = strlen(key) + strlen(value) + 2;
    put_int(to, 0, (uint32_t)length);
    memcpy(to + 4, key, strlen(key) + 1);
    memcpy(to + 4 + strlen(key) + 1, value, strlen(value) + 1);
    return (4 + length + 3) / 4 * 4;
}

/* Writes the box of the texture's coordinates from 0 to 1: half a cell around samples. */
static size_t put_keys(const GridSheet *sheet, unsigned char *to)
{
    const KrsGridShape *shape = &sheet->shape;
    char                box[256];
    double              low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k]  = place_of(shape, k, -0.5);
        high[k] = place_of(shape, k, (double)shape->count[k] - 0.5);
    }
    snprintf(box, sizeof box, "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g", low[0], low[1], low[2], high[0],
             high[1], high[2]);
    size_t length = put_key(to, "KTXorientation", "ruo");
    length += put_key(to + length, "KTXwriter", "krs " KRS_VERSION);
    return length + put_key(to + length, "krs.box", box);
}

/* Writes the basic data format descriptor: channels of so many bytes, signed, floating, linear. */
static size_t put_format(unsigned char *to, size_t channels, size_t bytes)
{
    static const unsigned char channel_ids[] = {0, 1, 2, 15}; /* red, green, blue, alpha */
    enum { RGBSDA = 1, BT709 = 1, LINEAR = 1, SIGNED_FLOAT = 0xC0, BEGIN = 28, SAMPLE = 16 };
    size_t length = BEGIN + SAMPLE * channels;
    put_int(to, 0, (uint32_t)length);
    put_int(to, 8, 2 | (uint32_t)(length - 4) << 16);
    to[12] = RGBSDA;
    to[13] = BT709;
    to[14] = LINEAR;
    to[20] = (unsigned char)(bytes * channels);
    for (size_t i = 0; i < channels; i++) {
        unsigned char *sample = to + BEGIN + SAMPLE * i;
        put_int(sample, 0,
                (uint32_t)(8 * bytes * i) | (uint32_t)(8 * bytes - 1) << 16 |
                    (uint32_t)(channel_ids[i] | SIGNED_FLOAT) << 24);
        put_int(sample, 8, 0xBF800000u);
        put_int(sample, 12, 0x3F800000u);
    }
    return length;
}

/* Begins a texture in three dimensions: the values as red, or the colour with the values as alpha. */
static bool begin_ktx2(GridFile *file)
{
    static const char     mark[]      = "\xABKTX 20\xBB\r\n\x1A\n";
    static const uint32_t kinds[2][2] = {{100, 109},
                                         {76, 97}}; /* R32_SFLOAT, R32G32B32A32_SFLOAT, R16... */
    enum { HEADER = 104, ALIGNED = 16 };
    const GridSheet *sheet              = file->sheet;
    unsigned char    header[MAX_HEADER] = {0};
    GridRows        *rows               = new_rows(file);
    GridArray       *array              = sheet->color ? add_array(rows, 4, RED, GREEN, BLUE, VALUE)
                                                       : add_array(rows, 1, VALUE);
    memcpy(header, mark, 12);
    put_int(header, 12, kinds[sheet->half][sheet->color]);
    put_int(header, 16, (uint32_t)number_bytes(sheet, VALUE));
    for (size_t k = 0; k < 3; k++)
        put_int(header, 20 + 4 * k, (uint32_t)sheet->shape.count[k]);
    put_int(header, 36, 1); /* face */
    put_int(header, 40, 1); /* level */
    size_t format = put_format(header + HEADER, array->count, number_bytes(sheet, VALUE));
    size_t keys   = put_keys(sheet, header + HEADER + format);
    size_t begin  = (HEADER + format + keys + ALIGNED - 1) / ALIGNED * ALIGNED;
    put_int(header, 48, HEADER);
    put_int(header, 52, (uint32_t)format);
    put_int(header, 56, (uint32_t)(HEADER + format));
    put_int(header, 60, (uint32_t)keys);
    put_long(header, 80, begin);
    put_long(header, 88, array_bytes(sheet, array));
    put_long(header, 96, array_bytes(sheet, array));
    place_arrays(file, begin, 0);
    return output_append(file->file, header, begin);
}

/* ---- VTK's images ---- */

static bool begin_vti(GridFile *file)
{
    const GridSheet    *sheet = file->sheet;
    const KrsGridShape *shape = &sheet->shape;
    GridRows           *rows  = new_rows(file);
    Text                text  = {.arena = file->arena};
    uint64_t            at    = 0;
    static const struct {
        const char *name, *type;
    } known[] = {{NULL, "Float32"}, {"color", "Float32"}, {"material", "UInt32"}};
    add_array(rows, 1, VALUE);
    if (sheet->color)
        add_array(rows, 3, RED, GREEN, BLUE);
    if (sheet->material)
        add_array(rows, 1, MATERIAL);
    text_format(&text,
                "<?xml version=\"1.0\"?>\n"
                "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" "
                "header_type=\"UInt64\">\n"
                "<ImageData WholeExtent=\"0 %zu 0 %zu 0 %zu\" Origin=\"%.17g %.17g %.17g\" "
                "Spacing=\"%.17g %.17g %.17g\">\n<Piece Extent=\"0 %zu 0 %zu 0 %zu\">\n"
                "<PointData Scalars=\"%s\">\n",
                shape->count[0] - 1, shape->count[1] - 1, shape->count[2] - 1,
                place_of(shape, 0, 0), place_of(shape, 1, 0), place_of(shape, 2, 0), shape->cell,
                shape->cell, shape->cell, shape->count[0] - 1, shape->count[1] - 1,
                shape->count[2] - 1, grid_name(sheet));
    for (size_t i = 0; i < rows->array_count; i++) {
        const GridArray *array = &rows->arrays[i];
        size_t           kind  = i == 0 ? 0 : array->numbers[0] == RED ? 1 : 2;
        text_format(&text,
                    "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%zu\" "
                    "format=\"appended\" offset=\"%llu\"/>\n",
                    known[kind].type, kind == 0 ? grid_name(sheet) : known[kind].name, array->count,
                    (unsigned long long)at);
        at += 8 + array_bytes(sheet, array);
    }
    text_add(&text, "</PointData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_");
    place_arrays(file, text.length, 8);
    rows->behind = "\n</AppendedData>\n</VTKFile>\n";
    for (size_t i = 0; i < rows->array_count; i++) {
        uint64_t bytes = array_bytes(sheet, &rows->arrays[i]);
        if (!output_write(file->file, &bytes, 8, rows->arrays[i].offset - 8))
            return false;
    }
    return output_write(file->file, text.bytes, text.length, 0);
}

/* ---- all formats ---- */

/* Rows of files that have all samples are made in memory.  OpenVDB wants volumes of cells above 3e-15. */
#define MAX_ROW   262144.0
#define MAX_INDEX 1073741824.0
#define MIN_VDB   1.5e-5

static const GridFormat formats[] = {
    {".npy", false, true, true, MAX_ROW, 0, begin_npy, add_to_row, end_rows},
    {".vdb", true, true, true, MAX_INDEX, MIN_VDB, grid_begin_vdb, grid_add_vdb, grid_end_vdb},
    {".nii", false, true, false, INT16_MAX, 0, begin_nii, add_to_row, end_rows},
    {".ktx2", false, false, true, MAX_ROW, 0, begin_ktx2, add_to_row, end_rows},
    {".vti", false, true, false, MAX_ROW, 0, begin_vti, add_to_row, end_rows},
    {".vtu", true, true, false, MAX_INDEX, 0, grid_begin_vtu, grid_add_vtu, grid_end_vtu}};

const GridFormat *grid_format(const char *path)
{
    const char *dot = strrchr(path, '.');
    if (strcmp(path, STANDARD_OUTPUT) == 0)
        return &formats[0];
    for (size_t i = 0; dot && i < sizeof formats / sizeof *formats; i++)
        if (strcasecmp(dot, formats[i].ending) == 0)
            return &formats[i];
    return NULL;
}

bool grid_is_vdb(const char *path)
{
    const GridFormat *format = grid_format(path);
    return format && format->begin == grid_begin_vdb;
}

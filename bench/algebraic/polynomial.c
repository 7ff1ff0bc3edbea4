/*
 * polynomial.c: a recursive descent over sums, products and powers, whose values are polynomials.
 */
#include "bench/algebraic/polynomial.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Reader {
    const char       *text, *at;
    const Definition *definitions;
} Reader;

static void refuse(const Reader *r, const char *why)
{
    fprintf(stderr, "algebraic: %s at `%s`\n", why, r->at);
    exit(1);
}

static void add(Polynomial *sum, const Polynomial *p, double times)
{
    for (int i = 0; i < SIDE * SIDE * SIDE; i++)
        (&sum->c[0][0][0])[i] += times * (&p->c[0][0][0])[i];
}

/* Rows of z: most coefficients of what is read here are 0. */
static void add_row(Polynomial *product, const double *row, const Polynomial *b, int x, int y)
{
    for (int i = 0; i + x < SIDE; i++)
        for (int j = 0; j + y < SIDE; j++)
            for (int k = 0; k < SIDE; k++)
                for (int m = 0; row[k] != 0 && m + k < SIDE; m++)
                    product->c[i + x][j + y][k + m] += row[k] * b->c[i][j][m];
}

static Polynomial multiply(const Polynomial *a, const Polynomial *b)
{
    Polynomial product = {0};
    for (int x = 0; x < SIDE; x++)
        for (int y = 0; y < SIDE; y++)
            add_row(&product, a->c[x][y], b, x, y);
    return product;
}

static char next(Reader *r)
{
    while (isspace((unsigned char)*r->at))
        r->at++;
    return *r->at;
}

static Polynomial read_sum(Reader *r);

static Polynomial read_name(Reader *r)
{
    size_t     length = strspn(r->at, "abcdefghijklmnopqrstuvwxyz0123456789");
    Polynomial p      = {0};
    if (length == 1 && *r->at >= 'x' && *r->at <= 'z') {
        p.c[*r->at == 'x'][*r->at == 'y'][*r->at == 'z'] = 1;
        r->at++;
        return p;
    }
    for (const Definition *d = r->definitions; d && d->name; d++)
        if (strlen(d->name) == length && strncmp(d->name, r->at, length) == 0) {
            r->at += length;
            return polynomial_read(d->text, r->definitions);
        }
    refuse(r, "an unknown name");
    return p;
}

static Polynomial read_base(Reader *r)
{
    Polynomial p = {0};
    char       c = next(r);
    if (c == '(') {
        r->at++;
        p = read_sum(r);
        if (next(r) != ')')
            refuse(r, "a parenthesis is not closed");
        r->at++;
    } else if (isdigit((unsigned char)c)) {
        char *end;
        p.c[0][0][0] = strtod(r->at, &end);
        r->at        = end;
    } else {
        p = read_name(r);
    }
    return p;
}

static Polynomial read_power(Reader *r)
{
    Polynomial base = read_base(r), power = base;
    if (next(r) != '^')
        return base;
    r->at++;
    for (long times = strtol(r->at, (char **)&r->at, 10); times > 1; times--)
        power = multiply(&power, &base);
    return power;
}

static Polynomial read_product(Reader *r)
{
    Polynomial product = read_power(r);
    while (next(r) == '*') {
        r->at++;
        Polynomial factor = read_power(r);
        product           = multiply(&product, &factor);
    }
    return product;
}

static Polynomial read_sum(Reader *r)
{
    Polynomial sum = {0};
    do {
        double sign = next(r) == '-' ? -1 : 1;
        r->at += *r->at == '-' || *r->at == '+';
        Polynomial term = read_product(r);
        add(&sum, &term, sign);
    } while (next(r) == '+' || *r->at == '-');
    return sum;
}

Polynomial polynomial_read(const char *text, const Definition *definitions)
{
    Reader     r = {text, text, definitions};
    Polynomial p = read_sum(&r);
    if (next(&r))
        refuse(&r, "something is left");
    return p;
}

double polynomial_value(const Polynomial *p, const double at[3])
{
    double sum = 0;
    for (int i = SIDE - 1; i >= 0; i--) {
        double plane = 0;
        for (int j = SIDE - 1; j >= 0; j--) {
            double row = 0;
            for (int k = SIDE - 1; k >= 0; k--)
                row = row * at[2] + p->c[i][j][k];
            plane = plane * at[1] + row;
        }
        sum = sum * at[0] + plane;
    }
    return sum;
}

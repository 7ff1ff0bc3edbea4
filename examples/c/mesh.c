/*
 * mesh.c: a mesh for a program, and what it can rely on: mesh SCENE.krs ERROR
 *
 * It prints the triangles, the volume, and whether each edge is in two triangles that agree which side is inside.  This
 * needs the library alone:
 *
 *     cc -Iinclude -o mesh examples/c/mesh.c build/libkrs.a $(make libs)
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <krs/krs.h>

static int compare_edges(const void *a, const void *b)
{
    return memcmp(a, b, 2 * sizeof(uint32_t));
}

/* Tells whether each edge is there once in each direction. */
static bool is_closed(const KrsMesh *mesh)
{
    size_t count        = 3 * mesh->triangle_count;
    uint32_t(*edges)[2] = malloc((count + 1) * sizeof *edges);
    bool closed         = edges != NULL;
    for (size_t i = 0; closed && i < count; i++) {
        edges[i][0] = mesh->triangles[i / 3][i % 3];
        edges[i][1] = mesh->triangles[i / 3][(i + 1) % 3];
    }
    if (closed)
        qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 0; closed && i < count; i++) {
        uint32_t back[2] = {edges[i][1], edges[i][0]};
        closed           = bsearch(back, edges, count, sizeof *edges, compare_edges) &&
                 (i == 0 || compare_edges(edges[i - 1], edges[i]) != 0);
    }
    free(edges);
    return closed;
}

/* Returns the sum of those of the tetrahedra from the origin. */
static double volume_of(const KrsMesh *mesh)
{
    double volume = 0;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const double *a = mesh->vertices[mesh->triangles[i][0]];
        const double *b = mesh->vertices[mesh->triangles[i][1]];
        const double *c = mesh->vertices[mesh->triangles[i][2]];
        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                   a[2] * (b[0] * c[1] - b[1] * c[0])) /
                  6;
    }
    return volume;
}

static void report(const KrsMesh *mesh)
{
    printf("%zu triangles, volume %g, %s, within %g\n", mesh->triangle_count, volume_of(mesh),
           is_closed(mesh) ? "closed" : "open", mesh->error);
    if (mesh->unresolved > 0)
        printf("%zu cells may hold what is thinner, as at %g %g %g\n", mesh->unresolved,
               mesh->unresolved_at[0], mesh->unresolved_at[1], mesh->unresolved_at[2]);
}

/* Prints the progress now and then; it may end the work. */
static bool report_progress(void *user, double fraction)
{
    (void)user;
    fprintf(stderr, "\r%3.0f %%", 100 * fraction);
    return true;
}

static void say(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    fputs(diagnostic->text, stderr);
}

int main(int argc, char **argv)
{
    KrsScene      *scene   = NULL;
    KrsState      *state   = NULL;
    KrsMesh       *mesh    = NULL;
    KrsMeshOptions options = {.error = argc > 2 ? atof(argv[2]) : 0, .progress = report_progress};
    KrsOptions     how     = {.diagnostic = say};
    if (argc != 3) {
        fputs("usage: mesh SCENE.krs ERROR\n", stderr);
        return KRS_BAD_ARGUMENT;
    }
    KrsStatus status = krs_compile_file(argv[1], &how, &scene);
    if (status == KRS_OK)
        status = krs_state_new(scene, &state);
    if (status == KRS_OK)
        status = krs_mesh(state, &options, &mesh);
    fputc('\n', stderr);
    if (status == KRS_OK)
        report(mesh);
    else
        fprintf(stderr, "no mesh: status %d\n", (int)status);
    krs_mesh_free(mesh); /* these take NULL */
    krs_state_free(state);
    krs_scene_free(scene);
    return status != KRS_OK;
}

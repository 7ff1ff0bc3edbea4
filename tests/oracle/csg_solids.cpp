/*
 * csg_solids.cpp: random solids by `krs mesh`, beside the same ones by CGAL's exact set operations.
 *
 *     csg_solids KRS COUNT [FIRST [FOLDER]]    COUNT solids from FIRST on; faults leave scenes in FOLDER
 *
 * CGAL gets polyhedra that are finer than the error (csg_polyhedra.h).  Components, the Euler number, the volume and distances
 * both ways are compared, and no two triangles may cross.  Where the meshes differ, or krs
 * reports a place, the solid is built twice more, with parts that are grown and shrunk so that it is thicker and
 * thinner by three errors.  If these are alike, then nothing of it is too small for the error.
 * Status 1: a mesh is wrong that should be right, or is wrong without a word.
 */
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>

#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/oracle/csg_truth.h"
#include "tests/oracle/mesh_faults.h"
#include "tests/oracle/truetype.h"

/* Seconds of the processor: for each mesh, and for all of CGAL beside it. */
static const int SECONDS = 20, SECONDS_OF_CGAL = 120;

/* ---- the command ---- */

struct Answer {
    int         status = 0;
    bool        slow   = false;
    std::string said; /* the first warning */
    Triangles   mesh;
};

static Triangles read_obj(const std::string &path)
{
    Triangles mesh;
    char      line[512];
    FILE     *file = std::fopen(path.c_str(), "r");
    while (file && std::fgets(line, sizeof line, file)) {
        Vec                        v;
        std::array<std::size_t, 3> t;
        if (std::sscanf(line, "v %lf %lf %lf", &v[0], &v[1], &v[2]) == 3)
            mesh.vertices.push_back(v);
        else if (std::sscanf(line, "f %zu%*[^ ] %zu%*[^ ] %zu", &t[0], &t[1], &t[2]) == 3 ||
                 std::sscanf(line, "f %zu %zu %zu", &t[0], &t[1], &t[2]) == 3)
            mesh.faces.push_back({t[0] - 1, t[1] - 1, t[2] - 1});
    }
    if (file)
        std::fclose(file);
    return mesh;
}

static Answer answer_of(const std::string &krs, const std::string &folder, const std::string &scene,
                        double error)
{
    char        command[1024], line[1024];
    std::string obj = folder + "/mesh.obj";
    Answer      answer;
    std::remove(obj.c_str());
    std::snprintf(command, sizeof command,
                  "ulimit -t %d; exec '%s' mesh '%s' --error %.17g -o '%s' 2>&1", SECONDS,
                  krs.c_str(), scene.c_str(), error, obj.c_str());
    FILE *pipe = popen(command, "r");
    if (!pipe)
        throw std::runtime_error("no pipe");
    while (std::fgets(line, sizeof line, pipe)) {
        answer.slow = answer.slow || std::strstr(line, "processor time that `ulimit -t` allows") ||
                      std::strstr(line, "killed by the system");
        if (answer.said.empty() && (std::strstr(line, "warning") || std::strstr(line, "error:")))
            answer.said = std::string(line, std::strcspn(line, "\n"));
    }
    int status    = pclose(pipe);
    answer.status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    answer.slow   = answer.slow || answer.status == -SIGKILL || answer.status == -SIGXCPU;
    if (answer.status == 0)
        answer.mesh = read_obj(obj);
    return answer;
}

/* ---- all of it ---- */

enum Verdict {
    AGREE,
    SMALL,
    REFUSED,
    SLOW,
    FALSE_REPORT,
    CROSSED,
    WRONG,
    SILENT,
    FAR,
    CRASHED,
    NOTHING,
    VERDICTS
};
static const char *const names[VERDICTS] = {
    "agree",
    "differ where something is smaller than three errors, and say so",
    "refused",
    "not done in time",
    "agree, but report what is not so small",
    "CROSSES ITSELF, or is no closed manifold",
    "WRONG, though nothing is smaller than three errors",
    "WRONG without a report",
    "RIGHT IN SHAPE, BUT TOO FAR",
    "CRASHED",
    "empty, or left out by CGAL",
};

/* Tells whether the solid is the same if it is thicker or thinner by three errors. */
static bool is_robust(const Solid &solid, const Shape &shape, int sides)
{
    try {
        for (double by : {-1.5, 1.5})
            if (!shape_of(truth_of(solid, by * solid.error, sides)).same(shape))
                return false;
    } catch (const std::exception &) {
        return false;
    }
    return true;
}

struct Tally {
    long   of[VERDICTS] = {0};
    double krs = 0, cgal = 0;
};

static double seconds_since(std::chrono::steady_clock::time_point begin)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

static int sides_for(const Solid &solid)
{
    int sides = 16;
    if (solid.level)
        return 32;
    while (sides < 96 && sag_of(*solid.tree, sides) > solid.error / 4)
        sides += 8;
    return sides;
}

/* Nine digits are rounded in the file: what touches may cross by less than this part of the size. */
static const double ROUNDING = 1e-7;

/* What CGAL finds, or nothing. */
static std::string fault_of(const Triangles &mesh)
{
    std::vector<std::vector<std::size_t>> faces;
    char                                  words[160] = "";
    double                                size       = 0;
    for (const auto &t : mesh.faces)
        faces.push_back({t[0], t[1], t[2]});
    for (const Vec &v : mesh.vertices)
        size = std::fmax(size, std::sqrt(dot(v, v)));
    Judgement judged = judge_mesh(mesh.vertices, faces);
    if (judged.crossings > 0 && judged.deepest > ROUNDING * size)
        std::snprintf(words, sizeof words, "crosses itself by %.2g at [%.6g, %.6g, %.6g]; ",
                      judged.deepest, judged.where[0], judged.where[1], judged.where[2]);
    else if (judged.fault && judged.crossings == 0)
        std::snprintf(words, sizeof words, "%s; ", judged.fault);
    return words;
}

/* From the truth to the mesh, or back. */
static double farthest_of(const Solid &solid, Triangles truth, const Triangles &mesh)
{
    for (Vec &v : truth.vertices)
        v = solid.turn(v);
    return std::fmax(farthest(mesh, truth), farthest(truth, mesh));
}

static Verdict verdict_of(const Solid &solid, const Triangles &truth, Shape shape,
                          const Answer &answer, int sides, std::string &why)
{
    char words[256];
    if (answer.slow)
        return SLOW;
    if (answer.status != 0)
        return answer.status < 0 ? CRASHED : REFUSED;
    Shape  found = shape_of(answer.mesh);
    double area = 30, sag = sag_of(*solid.tree, sides), most = 0;
    std::snprintf(words, sizeof words,
                  "%ld shells, Euler number %ld, volume %.6f; is %ld, %ld, %.6f", shape.shells,
                  shape.euler, shape.volume, found.shells, found.euler, found.volume);
    std::string fault = fault_of(answer.mesh);
    why               = fault + words;
    if (!fault.empty())
        return CROSSED;
    if (!found.same(shape) &&
        answer.said.empty()) { /* of what is that small, facets may have another shape */
        sides *= 4;
        shape = shape_of(truth_of(solid, 0, sides));
        std::snprintf(words, sizeof words,
                      "; %ld shells, Euler number %ld of four times as many facets", shape.shells,
                      shape.euler);
        why += words;
    }
    if (!found.closed || !found.same(shape)) {
        if (is_robust(solid, shape, sides))
            return WRONG;
        return answer.said.empty() ? SILENT : SMALL;
    }
    if (!answer.said.empty() && is_robust(solid, shape, sides))
        return FALSE_REPORT;
    if (answer.said.empty()) {
        most = farthest_of(solid, truth, answer.mesh);
        if (most > solid.error) { /* by facets of the truth, perhaps */
            sides *= 4;
            sag  = sag_of(*solid.tree, sides);
            most = farthest_of(solid, truth_of(solid, 0, sides), answer.mesh);
        }
        std::snprintf(words, sizeof words, "; %.3f errors away", most / solid.error);
        why += words;
        /* Edges are farther from those of facets than faces are. */
        if (most > solid.error + 6 * sag ||
            std::fabs(found.volume - shape.volume) > area * (solid.error + sag))
            return FAR;
    }
    return AGREE;
}

/* Opens the font of letters. */
static bool open_font()
{
    char  path[1024] = "";
    FILE *pipe       = popen("fc-match -f '%{file}' 'DejaVu Sans:bold'", "r");
    bool  read       = pipe && std::fgets(path, sizeof path, pipe) && truetype_open(path);
    if (pipe)
        pclose(pipe);
    return read;
}

struct Run {
    std::string krs, folder;
    Tally      *tally;
};

/* Prints what is found of a solid. */
static Verdict judge_solid(const Run &run, uint64_t number)
{
    Solid       solid = random_solid(number);
    std::string why, path = run.folder + "/" + std::to_string(number) + ".krs";
    int         sides = sides_for(solid);
    Triangles   truth;
    Shape       shape;
    auto        begin = std::chrono::steady_clock::now();
    try {
        truth = truth_of(solid, 0, sides);
        shape = shape_of(truth);
    } catch (const std::exception &problem) {
        why = problem.what();
    }
    run.tally->cgal += seconds_since(begin);
    if (truth.faces.empty() || !shape.closed || shape.volume < 1e-4) {
        std::printf("# %lu: left out, %s\n", (unsigned long)number,
                    why.empty() ? "empty" : why.c_str());
        return NOTHING;
    }
    FILE *file = std::fopen(path.c_str(), "w");
    if (!file ||
        std::fprintf(file, "// --error %.17g\n%s", solid.error, text_of(solid).c_str()) < 0 ||
        std::fclose(file) != 0) {
        std::perror(path.c_str());
        std::exit(74);
    }
    begin          = std::chrono::steady_clock::now();
    Answer answer  = answer_of(run.krs, run.folder, path, solid.error);
    double seconds = seconds_since(begin);
    run.tally->krs += seconds;
    Verdict verdict = verdict_of(solid, truth, shape, answer, sides, why);
    std::printf("# %lu%s, 1/%.0f, %.1f s, %zu triangles: %s: %s %s\n", (unsigned long)number,
                solid.level  ? ", level"
                : solid.rich ? ", rich"
                             : "",
                2 / solid.error, seconds, answer.mesh.faces.size(), names[verdict], why.c_str(),
                answer.said.c_str());
    if (verdict == AGREE)
        std::remove(path.c_str());
    return verdict;
}

/* In a process of its own: CGAL may take too long, or end by itself. */
static Verdict try_solid(const Run &run, uint64_t number)
{
    int status = 0;
    std::fflush(stdout);
    pid_t child = fork();
    if (child == 0) {
        const struct rlimit limit = {SECONDS_OF_CGAL, SECONDS_OF_CGAL};
        setrlimit(RLIMIT_CPU, &limit);
        Verdict verdict = judge_solid(run, number);
        std::fflush(stdout);
        _exit(verdict);
    }
    if (child < 0 || waitpid(child, &status, 0) < 0)
        throw std::runtime_error("no process");
    if (WIFEXITED(status) && WEXITSTATUS(status) < VERDICTS)
        return Verdict(WEXITSTATUS(status));
    if (WIFEXITED(status))
        std::exit(WEXITSTATUS(status));
    std::printf("# %lu: left out, CGAL is ended by signal %d\n", (unsigned long)number,
                WTERMSIG(status));
    return NOTHING;
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        std::fputs("usage: csg_solids KRS COUNT [FIRST [FOLDER]]\n", stderr);
        return 64;
    }
    if (!open_font()) {
        std::fputs("csg_solids: no DejaVu Sans Bold\n", stderr);
        return 69;
    }
    uint64_t count = std::strtoull(argv[2], nullptr, 10),
             first = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 0;
    void *shared = mmap(nullptr, sizeof(Tally), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS,
                        -1, 0);
    if (shared == MAP_FAILED)
        return 71;
    Tally *tally = new (shared) Tally;
    Run    run   = {argv[1], argc > 4 ? argv[4] : ".", tally};
    for (uint64_t number = first; number < first + count; number++)
        tally->of[try_solid(run, number)]++;
    for (int i = 0; i < VERDICTS; i++)
        std::printf("# %5ld %s\n", tally->of[i], names[i]);
    std::printf("# %.0f s by krs, %.0f s by CGAL\n", tally->krs, tally->cgal);
    bool good = true;
    for (Verdict bad : {CROSSED, WRONG, SILENT, FAR, CRASHED})
        good = good && tally->of[bad] == 0;
    return good ? 0 : 1;
}

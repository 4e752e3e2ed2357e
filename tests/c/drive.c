/* Drives the FMU's library from plain C, as an importer does.
 *
 *     drive LIBRARY GUID RESOURCES wind STEPS      prints every output after every step, bit by bit
 *     drive LIBRARY GUID RESOURCES cycles COUNT    instantiate, run, free, COUNT times over
 *     drive LIBRARY GUID RESOURCES reload COUNT    load the library, run, free, unload it, COUNT times over
 *     drive LIBRARY GUID RESOURCES refusals        what must be refused is, and the run goes on
 *     drive LIBRARY GUID RESOURCES rounding STEPS  however the host rounds: the same bits, and it still rounds so
 *     drive LIBRARY GUID RESOURCES states          saved and serialised states continue bit by bit
 *     drive LIBRARY GUID RESOURCES forget          never frees: shows that a leak checker sees it
 *
 * Exit code 0: all as expected; 1: not, with the line on standard error. The same source is built
 * for Linux (where it also runs under valgrind and the address sanitizer) and for Windows.
 */
#include "fmi2.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef __x86_64__
#include <xmmintrin.h>
#endif

#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

#define CHECK(condition) \
    do { \
        if (!(condition)) { \
            fprintf(stderr, "drive.c:%d: not so: %s\nlast message: %s\n", __LINE__, #condition, \
                    last_message); \
            exit(1); \
        } \
    } while (0)
#define OK(call) CHECK((call) == fmi2OK)
/* A refusal is an error, and says why in one message. */
#define REFUSED(call) \
    do { \
        int told = messages; \
        CHECK((call) == fmi2Error); \
        CHECK(messages == told + 1); \
        CHECK(strlen(last_message) > 10); \
    } while (0)

/* Function pointers by the names of the standard. */
#define POINTER(result, name, parameters) static result(*name) parameters;
FMI2_FUNCTIONS(POINTER)

static char last_message[4096] = "none";
static int messages = 0;
static int environment = 42;

/* What the importer has to do with the variadic message; the environment must come back. */
static void logger(fmi2ComponentEnvironment given, fmi2String name, fmi2Status status,
                   fmi2String category, fmi2String format, ...) {
    va_list arguments;
    CHECK(given == &environment);
    CHECK(name != NULL && category != NULL && format != NULL);
    CHECK(status >= fmi2OK && status <= fmi2Fatal);
    CHECK(strncmp(category, "log", 3) == 0);
    va_start(arguments, format);
    vsnprintf(last_message, sizeof last_message, format, arguments);
    va_end(arguments);
    messages++;
}

static const fmi2CallbackFunctions callbacks = {logger, NULL, NULL, NULL, &environment};

static void *symbol(void *library, const char *name) {
#ifdef _WIN32
    return (void *)GetProcAddress((HMODULE)library, name);
#else
    return dlsym(library, name);
#endif
}

static void *library;

/* Stays loaded to the end but for one task: the leak checkers want to see where memory came from. */
static void load(const char *path) {
#ifdef _WIN32
    library = (void *)LoadLibraryA(path);
    if (library == NULL) {
        fprintf(stderr, "cannot load %s: error %lu\n", path, GetLastError());
        exit(1);
    }
#else
    library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) {
        fprintf(stderr, "%s\n", dlerror());
        exit(1);
    }
#endif
#define BIND(result, name, parameters) \
    do { \
        void *found = symbol(library, #name); \
        CHECK(found != NULL && #name); \
        memcpy(&name, &found, sizeof found); \
    } while (0);
    FMI2_FUNCTIONS(BIND)
}

static void unload(void) {
#ifdef _WIN32
    CHECK(FreeLibrary((HMODULE)library));
#else
    CHECK(dlclose(library) == 0);
#endif
}

static const char *guid;
static const char *resources;

/* References never change their meaning. */
enum { SPINDLE_SPEED = 0, NOZZLE_POSITION = 1, WIRE_TENSION = 100 };
enum { CORE_SHAPE = 1100, WIRE_DIAMETER = 1002, FRICTION_STATIC = 1800, SCENE_FILE = 2300 };

static const fmi2ValueReference reals[] = {100, 101, 102, 110, 111, 112, 113, 114, 115,
                                           116, 118, 119, 120, 121, 122, 123, 124, 125,
                                           126, 127, 128, 200, 201, 203, 204};
static const fmi2ValueReference integers[] = {108, 109, 117, 202};
static const fmi2ValueReference booleans[] = {103, 104, 105, 106, 107};
#define COUNT(array) (sizeof(array) / sizeof(array)[0])

/* A power of two, so that communication points carry no rounding: about 2 ms. */
static const double STEP = 1.0 / 512.0;

static fmi2Component instantiate(void) {
    fmi2Component c =
        fmi2Instantiate("drive", fmi2CoSimulation, guid, resources, &callbacks, 0, 0);
    CHECK(c != NULL);
    return c;
}

static void set_inputs(fmi2Component c, double speed, double nozzle) {
    const fmi2ValueReference vr[] = {SPINDLE_SPEED, NOZZLE_POSITION};
    const double values[] = {speed, nozzle};
    OK(fmi2SetReal(c, vr, 2, values));
}

static void start(fmi2Component c) {
    const fmi2ValueReference vr[] = {SCENE_FILE};
    const fmi2String scene[] = {"fig8"};
    OK(fmi2SetString(c, vr, 1, scene));
    OK(fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0));
    OK(fmi2EnterInitializationMode(c));
    OK(fmi2ExitInitializationMode(c));
}

/* Step k of a wind: the speed rises to 30 rad/s within 54 steps, the nozzle follows the turns. */
static void step(fmi2Component c, int k) {
    double share = k < 54 ? (k + 0.5) / 54.0 : 1.0;
    double turns = k < 54 ? 0.25 * (k + 1) * (k + 1) / (54.0 * 54.0) : 0.25 + (k - 53) / 107.0;
    set_inputs(c, 30.0 * share, 0.7e-3 * turns);
    OK(fmi2DoStep(c, k * STEP, STEP, 1));
}

/* All outputs and diagnostics as one row of bit patterns. */
static void read(fmi2Component c, uint64_t *row) {
    double r[COUNT(reals)];
    int i[COUNT(integers)], b[COUNT(booleans)];
    size_t n = 0;
    OK(fmi2GetReal(c, reals, COUNT(reals), r));
    OK(fmi2GetInteger(c, integers, COUNT(integers), i));
    OK(fmi2GetBoolean(c, booleans, COUNT(booleans), b));
    for (size_t k = 0; k < COUNT(reals); k++) {
        CHECK(isfinite(r[k]));
        memcpy(&row[n++], &r[k], sizeof r[k]);
    }
    for (size_t k = 0; k < COUNT(integers); k++) row[n++] = (uint32_t)i[k];
    for (size_t k = 0; k < COUNT(booleans); k++) {
        CHECK(b[k] == 0 || b[k] == 1);
        row[n++] = (uint32_t)b[k];
    }
}
#define ROW (COUNT(reals) + COUNT(integers) + COUNT(booleans))

static void wind(int steps) {
    uint64_t row[ROW];
    fmi2Component c = instantiate();
    start(c);
    for (int k = 0; k < steps; k++) {
        step(c, k);
        read(c, row);
        for (size_t n = 0; n < ROW; n++) printf("%016" PRIx64 "%c", row[n], n + 1 < ROW ? ' ' : '\n');
    }
    OK(fmi2Terminate(c));
    fmi2FreeInstance(c);
}

#ifdef __x86_64__
/* Bits of the control word that say what to do: the rest tells what has happened. */
#define SET 0xffc0u
#define STANDARD 0x1f80u
static unsigned host_word;

static void as_host(void) { _mm_setcsr(host_word); }
static void as_standard(void) {
    CHECK((_mm_getcsr() & SET) == host_word);
    _mm_setcsr(STANDARD);
}

static void wind_into(uint64_t (*rows)[ROW], int steps) {
    const fmi2ValueReference vr[] = {SPINDLE_SPEED, NOZZLE_POSITION};
    fmi2Component c;
    as_host();
    c = instantiate();
    start(c);
    as_standard();
    for (int k = 0; k < steps; k++) {
        const double inputs[] = {30.0 * (k < 54 ? (k + 0.5) / 54.0 : 1.0), 1e-6 * k};
        const double now = k * STEP;
        fmi2Status set, done;
        as_host();
        set = fmi2SetReal(c, vr, 2, inputs);
        done = fmi2DoStep(c, now, STEP, 1);
        read(c, rows[k]);
        as_standard();
        CHECK(set == fmi2OK && done == fmi2OK);
    }
    as_host();
    CHECK(fmi2DoStep(c, 0.0, -1.0, 1) == fmi2Error);
    fmi2FreeInstance(c);
    as_standard();
}

/* Tiny numbers as zero; upwards, downwards, to zero; traps on division by zero and invalid operations. */
static void rounding(int steps) {
    static const unsigned words[] = {STANDARD,          STANDARD | 0x8040, STANDARD | 0x4000,
                                     STANDARD | 0x2000, STANDARD | 0x6000, STANDARD & ~0x280u};
    uint64_t(*first)[ROW] = malloc((size_t)steps * sizeof *first);
    uint64_t(*rows)[ROW] = malloc((size_t)steps * sizeof *rows);
    CHECK(first != NULL && rows != NULL);
    for (size_t w = 0; w < COUNT(words); w++) {
        host_word = words[w];
        wind_into(w == 0 ? first : rows, steps);
        CHECK(w == 0 || memcmp(first, rows, (size_t)steps * sizeof *first) == 0);
    }
    free(first);
    free(rows);
}
#else
static void rounding(int steps) { (void)steps; }
#endif

/* Every way in which a run can end. */
static void cycles(int count) {
    uint64_t row[ROW];
    for (int n = 0; n < count; n++) {
        fmi2Component c = instantiate();
        const fmi2ValueReference shape[] = {CORE_SHAPE};
        fmi2String text[1];
        start(c);
        step(c, 0);
        step(c, 1);
        read(c, row);
        OK(fmi2GetString(c, shape, 1, text));
        CHECK(strcmp(text[0], "rounded-box") == 0);
        switch (n % 4) {
        case 0: OK(fmi2Terminate(c)); break;
        case 1: OK(fmi2Reset(c)); break;
        case 2: REFUSED(fmi2DoStep(c, 2 * STEP, -STEP, 1)); break;
        default: break;
        }
        fmi2FreeInstance(c);
    }
}

/* A host that lets the library go between runs; every run is the first. */
static void reload(const char *path, int count) {
    uint64_t first[ROW], row[ROW];
    for (int n = 0; n < count; n++) {
        fmi2Component c = instantiate();
        start(c);
        step(c, 0);
        read(c, n == 0 ? first : row);
        fmi2FreeInstance(c);
        CHECK(n == 0 || memcmp(first, row, sizeof row) == 0);
        unload();
        load(path);
    }
}

/* The only handle goes out of use here, and with it all that the instance holds. */
/* Several: what is left of one on the stack would hide it from a leak checker. */
static void forget(void) {
    for (int k = 0; k < 8; k += 1) {
        volatile fmi2Component c = instantiate();
        start(c);
        c = NULL;
    }
}

static void refuse_instances(void) {
    const fmi2CallbackFunctions silent = {NULL, NULL, NULL, NULL, NULL};
    int told = messages;
    CHECK(fmi2Instantiate("x", fmi2CoSimulation, "{no}", resources, &callbacks, 0, 0) == NULL);
    CHECK(fmi2Instantiate("x", fmi2ModelExchange, guid, resources, &callbacks, 0, 0) == NULL);
    CHECK(fmi2Instantiate("", fmi2CoSimulation, guid, resources, &callbacks, 0, 0) == NULL);
    CHECK(fmi2Instantiate(NULL, fmi2CoSimulation, guid, resources, &callbacks, 0, 0) == NULL);
    CHECK(fmi2Instantiate("x", fmi2CoSimulation, NULL, resources, &callbacks, 0, 0) == NULL);
    CHECK(messages == told + 5);
    CHECK(fmi2Instantiate("x", fmi2CoSimulation, "{no}", NULL, NULL, 0, 0) == NULL);
    /* Callbacks, each of them, and resources are optional. */
    fmi2Component c = fmi2Instantiate("x", fmi2CoSimulation, guid, NULL, NULL, 0, 1);
    CHECK(c != NULL);
    CHECK(fmi2Terminate(c) == fmi2Error);
    fmi2FreeInstance(c);
    c = fmi2Instantiate("x", fmi2CoSimulation, guid, NULL, &silent, 0, 1);
    CHECK(c != NULL);
    CHECK(fmi2Terminate(c) == fmi2Error);
    fmi2FreeInstance(c);
    fmi2FreeInstance(NULL);
}

/* Every function that takes a component, on none. */
static void refuse_null_components(void) {
    fmi2Status status;
    size_t size;
    CHECK(fmi2SetDebugLogging(NULL, 1, 0, NULL) == fmi2Error);
    CHECK(fmi2SetupExperiment(NULL, 0, 0.0, 0.0, 0, 0.0) == fmi2Error);
    CHECK(fmi2EnterInitializationMode(NULL) == fmi2Error);
    CHECK(fmi2ExitInitializationMode(NULL) == fmi2Error);
    CHECK(fmi2Terminate(NULL) == fmi2Error);
    CHECK(fmi2Reset(NULL) == fmi2Error);
    CHECK(fmi2GetReal(NULL, NULL, 0, NULL) == fmi2Error);
    CHECK(fmi2GetInteger(NULL, NULL, 0, NULL) == fmi2Error);
    CHECK(fmi2GetBoolean(NULL, NULL, 0, NULL) == fmi2Error);
    CHECK(fmi2GetString(NULL, NULL, 0, NULL) == fmi2Error);
    CHECK(fmi2SetReal(NULL, NULL, 0, NULL) == fmi2Error);
    CHECK(fmi2SetInteger(NULL, NULL, 0, NULL) == fmi2Error);
    CHECK(fmi2SetBoolean(NULL, NULL, 0, NULL) == fmi2Error);
    CHECK(fmi2SetString(NULL, NULL, 0, NULL) == fmi2Error);
    CHECK(fmi2GetFMUstate(NULL, NULL) == fmi2Error);
    CHECK(fmi2SetFMUstate(NULL, NULL) == fmi2Error);
    CHECK(fmi2FreeFMUstate(NULL, NULL) == fmi2Error);
    CHECK(fmi2SerializedFMUstateSize(NULL, NULL, &size) == fmi2Error);
    CHECK(fmi2SerializeFMUstate(NULL, NULL, NULL, 0) == fmi2Error);
    CHECK(fmi2DeSerializeFMUstate(NULL, NULL, 0, NULL) == fmi2Error);
    CHECK(fmi2GetDirectionalDerivative(NULL, NULL, 0, NULL, 0, NULL, NULL) == fmi2Error);
    CHECK(fmi2SetRealInputDerivatives(NULL, NULL, 0, NULL, NULL) == fmi2Error);
    CHECK(fmi2GetRealOutputDerivatives(NULL, NULL, 0, NULL, NULL) == fmi2Error);
    CHECK(fmi2DoStep(NULL, 0.0, STEP, 1) == fmi2Error);
    CHECK(fmi2CancelStep(NULL) == fmi2Error);
    CHECK(fmi2GetStatus(NULL, fmi2DoStepStatus, &status) == fmi2Error);
    CHECK(fmi2GetRealStatus(NULL, fmi2LastSuccessfulTime, NULL) == fmi2Error);
    CHECK(fmi2GetIntegerStatus(NULL, fmi2DoStepStatus, NULL) == fmi2Error);
    CHECK(fmi2GetBooleanStatus(NULL, fmi2Terminated, NULL) == fmi2Error);
    CHECK(fmi2GetStringStatus(NULL, fmi2PendingStatus, NULL) == fmi2Error);
}

static void refuse_values(fmi2Component c) {
    const fmi2ValueReference unknown[] = {4000000000u}, tension[] = {WIRE_TENSION};
    const fmi2ValueReference shape[] = {CORE_SHAPE}, diameter[] = {WIRE_DIAMETER};
    const fmi2ValueReference speed[] = {SPINDLE_SPEED};
    const double no_number[] = {NAN}, endless[] = {INFINITY}, one[] = {1.0};
    const fmi2String no_string[] = {NULL}, no_text[] = {"\xff\xfe"};
    double value[1];
    fmi2String text[1];
    REFUSED(fmi2GetReal(c, unknown, 1, value));
    REFUSED(fmi2GetReal(c, shape, 1, value));
    REFUSED(fmi2GetReal(c, NULL, 1, value));
    REFUSED(fmi2GetReal(c, tension, 1, NULL));
    REFUSED(fmi2GetString(c, tension, 1, text));
    REFUSED(fmi2SetReal(c, NULL, 1, one));
    REFUSED(fmi2SetReal(c, speed, 1, NULL));
    REFUSED(fmi2SetReal(c, speed, 1, no_number));
    REFUSED(fmi2SetReal(c, speed, 1, endless));
    REFUSED(fmi2SetReal(c, tension, 1, one));
    REFUSED(fmi2SetReal(c, diameter, 1, one));
    REFUSED(fmi2SetString(c, shape, 1, no_string));
    REFUSED(fmi2SetString(c, shape, 1, no_text));
    /* Nothing is always fine. */
    OK(fmi2GetReal(c, NULL, 0, NULL));
    OK(fmi2GetInteger(c, NULL, 0, NULL));
    OK(fmi2GetBoolean(c, NULL, 0, NULL));
    OK(fmi2GetString(c, NULL, 0, NULL));
    OK(fmi2SetReal(c, NULL, 0, NULL));
    OK(fmi2SetInteger(c, NULL, 0, NULL));
    OK(fmi2SetBoolean(c, NULL, 0, NULL));
    OK(fmi2SetString(c, NULL, 0, NULL));
}

static void refuse_steps(fmi2Component c, double now) {
    const double no_step[] = {0.0, -STEP, NAN, INFINITY};
    double time = 0.0;
    fmi2Boolean over = 1;
    for (size_t k = 0; k < COUNT(no_step); k++) REFUSED(fmi2DoStep(c, now, no_step[k], 1));
    REFUSED(fmi2DoStep(c, now + 1.0, STEP, 1));
    REFUSED(fmi2DoStep(c, NAN, STEP, 1));
    REFUSED(fmi2CancelStep(c));
    REFUSED(fmi2EnterInitializationMode(c));
    REFUSED(fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0));
    REFUSED(fmi2GetRealStatus(c, fmi2LastSuccessfulTime, NULL));
    OK(fmi2GetRealStatus(c, fmi2LastSuccessfulTime, &time));
    CHECK(time == now);
    OK(fmi2GetBooleanStatus(c, fmi2Terminated, &over));
    CHECK(over == 0);
    CHECK(fmi2GetStatus(c, fmi2DoStepStatus, NULL) == fmi2Discard);
    CHECK(fmi2GetStringStatus(c, fmi2PendingStatus, NULL) == fmi2Discard);
    CHECK(fmi2GetRealStatus(c, (fmi2StatusKind)77, &time) != fmi2OK);
}

/* A run that is asked nonsense in between equals one that is not, bit by bit. */
static void refusals(void) {
    const fmi2String nonsense[] = {"logNonsense"};
    uint64_t asked[ROW], left_alone[ROW];
    refuse_instances();
    refuse_null_components();
    fmi2Component c = instantiate(), d = instantiate();
    REFUSED(fmi2DoStep(c, 0.0, STEP, 1));
    REFUSED(fmi2ExitInitializationMode(c));
    REFUSED(fmi2SetDebugLogging(c, 1, 1, nonsense));
    start(c);
    start(d);
    for (int k = 0; k < 3; k++) {
        refuse_values(c);
        refuse_steps(c, k * STEP);
        step(c, k);
        step(d, k);
    }
    read(c, asked);
    read(d, left_alone);
    CHECK(memcmp(asked, left_alone, sizeof asked) == 0);
    /* The friction coefficient is tunable: from here on the two differ. */
    const fmi2ValueReference friction[] = {FRICTION_STATIC};
    const double rough[] = {0.5};
    double value[1];
    OK(fmi2SetReal(c, friction, 1, rough));
    OK(fmi2GetReal(c, friction, 1, value));
    CHECK(value[0] == 0.5);
    OK(fmi2Terminate(c));
    REFUSED(fmi2DoStep(c, 3 * STEP, STEP, 1));
    OK(fmi2Reset(c));
    start(c);
    for (int k = 0; k < 3; k++) step(c, k);
    read(c, asked);
    CHECK(memcmp(asked, left_alone, sizeof asked) == 0);
    fmi2FreeInstance(c);
    fmi2FreeInstance(d);
}

/* Ten steps from step 10 on, in one row. */
static void ten_more(fmi2Component c, uint64_t *row) {
    for (int k = 10; k < 20; k++) step(c, k);
    read(c, row);
}

static void states(void) {
    uint64_t expected[ROW], row[ROW];
    fmi2FMUstate state = NULL, copy = NULL;
    size_t size = 0;
    fmi2Component c = instantiate();
    start(c);
    for (int k = 0; k < 10; k++) step(c, k);
    OK(fmi2GetFMUstate(c, &state));
    CHECK(state != NULL);
    ten_more(c, expected);
    OK(fmi2SetFMUstate(c, state));
    ten_more(c, row);
    CHECK(memcmp(row, expected, sizeof row) == 0);

    OK(fmi2SerializedFMUstateSize(c, state, &size));
    CHECK(size > 0);
    fmi2Byte *bytes = malloc(size);
    CHECK(bytes != NULL);
    OK(fmi2SerializeFMUstate(c, state, bytes, size));
    REFUSED(fmi2SerializeFMUstate(c, state, NULL, size));
    REFUSED(fmi2SetFMUstate(c, NULL));
    OK(fmi2FreeFMUstate(c, &state));
    CHECK(state == NULL);
    OK(fmi2FreeFMUstate(c, &state));
    OK(fmi2FreeFMUstate(c, NULL));
    fmi2FreeInstance(c);

    /* A fresh instance takes it up from the bytes alone. */
    c = instantiate();
    start(c);
    OK(fmi2DeSerializeFMUstate(c, bytes, size, &copy));
    OK(fmi2SetFMUstate(c, copy));
    ten_more(c, row);
    CHECK(memcmp(row, expected, sizeof row) == 0);
    OK(fmi2FreeFMUstate(c, &copy));

    /* Cut short or spoilt they are refused; the sanitizers see whether anything was read beyond. */
    for (size_t cut = 0; cut < size; cut += 1 + size / 97) {
        fmi2Byte *part = malloc(cut + 1);
        CHECK(part != NULL);
        memcpy(part, bytes, cut);
        REFUSED(fmi2DeSerializeFMUstate(c, part, cut, &copy));
        free(part);
        bytes[cut] = (fmi2Byte)(bytes[cut] ^ 0x55);
        REFUSED(fmi2DeSerializeFMUstate(c, bytes, size, &copy));
        bytes[cut] = (fmi2Byte)(bytes[cut] ^ 0x55);
    }
    REFUSED(fmi2DeSerializeFMUstate(c, NULL, size, &copy));
    CHECK(copy == NULL);
    free(bytes);
    fmi2FreeInstance(c);
}

int main(int count, char **arguments) {
    if (count < 5) {
        fprintf(stderr, "usage: drive LIBRARY GUID RESOURCES TASK [COUNT]\n");
        return 2;
    }
    load(arguments[1]);
    guid = arguments[2];
    resources = arguments[3];
    const char *task = arguments[4];
    int number = count > 5 ? atoi(arguments[5]) : 10;
    CHECK(strcmp(fmi2GetTypesPlatform(), "default") == 0);
    CHECK(strcmp(fmi2GetVersion(), "2.0") == 0);
    if (strcmp(task, "wind") == 0) wind(number);
    else if (strcmp(task, "cycles") == 0) cycles(number);
    else if (strcmp(task, "refusals") == 0) refusals();
    else if (strcmp(task, "reload") == 0) reload(arguments[1], number);
    else if (strcmp(task, "rounding") == 0) rounding(number);
    else if (strcmp(task, "states") == 0) states();
    else if (strcmp(task, "forget") == 0) forget();
    else {
        fprintf(stderr, "unknown task %s\n", task);
        return 2;
    }
    fprintf(stderr, "%s: done\n", task);
    return 0;
}

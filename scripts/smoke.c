/* Loads the library of a package and steps it, as an importer does.
   Usage: smoke LIBRARY GUID RESOURCE_LOCATION */
#include <stdio.h>
#include <stdlib.h>
#ifdef _WIN32
#include <windows.h>
#define SYSTEM "Windows"
#else
#include <dlfcn.h>
#define SYSTEM "Linux"
typedef void *HMODULE;
typedef void *FARPROC;
#define LoadLibraryA(path) dlopen(path, RTLD_NOW)
#define GetProcAddress dlsym
#define GetLastError() 0ul
#endif

typedef struct {
    void *logger, *allocate, *free, *step_finished, *environment;
} Callbacks;

static const char *const NAMES[] = {
    "fmi2GetTypesPlatform", "fmi2GetVersion", "fmi2SetDebugLogging", "fmi2Instantiate", "fmi2FreeInstance",
    "fmi2SetupExperiment", "fmi2EnterInitializationMode", "fmi2ExitInitializationMode", "fmi2Terminate", "fmi2Reset",
    "fmi2GetReal", "fmi2GetInteger", "fmi2GetBoolean", "fmi2GetString", "fmi2SetReal", "fmi2SetInteger",
    "fmi2SetBoolean", "fmi2SetString", "fmi2GetFMUstate", "fmi2SetFMUstate", "fmi2FreeFMUstate",
    "fmi2SerializedFMUstateSize", "fmi2SerializeFMUstate", "fmi2DeSerializeFMUstate", "fmi2GetDirectionalDerivative",
    "fmi2SetRealInputDerivatives", "fmi2GetRealOutputDerivatives", "fmi2DoStep", "fmi2CancelStep", "fmi2GetStatus",
    "fmi2GetRealStatus", "fmi2GetIntegerStatus", "fmi2GetBooleanStatus", "fmi2GetStringStatus"};

static HMODULE library;

static FARPROC function(const char *name) {
    FARPROC found = GetProcAddress(library, name);
    if (!found) {
        fprintf(stderr, "%s is missing\n", name);
        exit(1);
    }
    return found;
}

static void check(int status, const char *what) {
    if (status != 0) {
        fprintf(stderr, "%s returned %d\n", what, status);
        exit(1);
    }
}

int main(int count, char **arguments) {
    if (count != 4) return 2;
    library = LoadLibraryA(arguments[1]);
    if (!library) {
        fprintf(stderr, "%s cannot be loaded: error %lu\n", arguments[1], GetLastError());
        return 1;
    }
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++) function(NAMES[i]);
    typedef void *(*Instantiate)(const char *, int, const char *, const char *, const Callbacks *, int, int);
    typedef int (*Call)(void *);
    Callbacks callbacks = {0};
    void *bearing =
        ((Instantiate)function("fmi2Instantiate"))("bearing", 1, arguments[2], arguments[3], &callbacks, 0, 0);
    if (!bearing) {
        fprintf(stderr, "no instance\n");
        return 1;
    }
    check(((int (*)(void *, int, double, double, int, double))function("fmi2SetupExperiment"))(bearing, 0, 0, 0, 0, 0),
          "fmi2SetupExperiment");
    check(((Call)function("fmi2EnterInitializationMode"))(bearing), "fmi2EnterInitializationMode");
    check(((Call)function("fmi2ExitInitializationMode"))(bearing), "fmi2ExitInitializationMode");
    for (int k = 0; k < 20; k++)
        check(((int (*)(void *, double, double, int))function("fmi2DoStep"))(bearing, k * 1e-4, 1e-4, 0), "fmi2DoStep");
    double reached = 0;
    check(((int (*)(void *, int, double *))function("fmi2GetRealStatus"))(bearing, 2, &reached), "fmi2GetRealStatus");
    ((void (*)(void *))function("fmi2FreeInstance"))(bearing);
    printf(SYSTEM " library: 34 functions, 20 steps to %g s\n", reached);
    return reached > 1.9e-3 ? 0 : 1;
}

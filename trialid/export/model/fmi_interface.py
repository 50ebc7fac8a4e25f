"""FMI 2.0 for co-simulation in C: its types, so that no header has to be at hand, and its calls.

The names and types are those of the standard (FMI 2.0.4, `fmi2TypesPlatform.h`, `fmi2Functions.h`).
"""

from typing import Final

TYPES: Final = """\
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#if defined(_WIN32)
#define EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define EXPORT __attribute__((visibility("default")))
#else
#define EXPORT
#endif

typedef void *fmi2Component, *fmi2ComponentEnvironment, *fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer, fmi2Boolean;
typedef char fmi2Char, fmi2Byte;
typedef const char *fmi2String;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum {
  fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated
} fmi2StatusKind;
typedef struct {
  void (*logger)(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String, ...);
  void *(*allocateMemory)(size_t, size_t);
  void (*freeMemory)(void *);
  void (*stepFinished)(fmi2ComponentEnvironment, fmi2Status);
  fmi2ComponentEnvironment environment;
} fmi2CallbackFunctions;
"""

INTERFACE: Final = """\
enum { NX = $NX, NU = $NU, NY = $NY, NP = $NP, ALL = NX + NU + NY + NP, FLAG = ALL };

/* Values by their references: states, inputs, what sensors show, parameters. */
typedef struct {
  double values[ALL + 1], time;
  int unseen, begun, told;
  fmi2CallbackFunctions calls;
  char name[128];
} Instance;

static const double start[ALL + 1] = {$START};

static void reset(Instance *m) {
  memcpy(m->values, start, sizeof start);
  m->time = 0.0;
  m->unseen = m->begun = m->told = 0;
}

static void say(Instance *m, fmi2Status status, const char *category, const char *words) {
  if (m->calls.logger)
    m->calls.logger(m->calls.environment, m->name, status, category, "%s", words);
}

static void refresh(Instance *m) {
  double *v = m->values;
  ${LOW}_outputs(v, v + NX, v + NX + NU + NY, v + NX + NU);
  if (m->begun) m->unseen |= ${LOW}_unseen(v, v + NX);
}

EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }

EXPORT fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n,
                                      const fmi2String categories[]) {
  (void)c; (void)on; (void)n; (void)categories;
  return fmi2OK;
}

EXPORT fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid,
                                     fmi2String resources, const fmi2CallbackFunctions *calls,
                                     fmi2Boolean visible, fmi2Boolean logging) {
  (void)resources; (void)visible; (void)logging;
  if (type != fmi2CoSimulation || !guid || strcmp(guid, "$GUID")) return NULL;
  Instance *m = calloc(1, sizeof *m);
  if (!m) return NULL;
  if (calls) m->calls = *calls;
  if (name) strncpy(m->name, name, sizeof m->name - 1);
  reset(m);
  return m;
}

EXPORT void fmi2FreeInstance(fmi2Component c) { free(c); }

EXPORT fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerant, fmi2Real tolerance,
                                      fmi2Real from, fmi2Boolean ends, fmi2Real to) {
  (void)tolerant; (void)tolerance; (void)ends; (void)to;
  ((Instance *)c)->time = from;
  return fmi2OK;
}

EXPORT fmi2Status fmi2EnterInitializationMode(fmi2Component c) { (void)c; return fmi2OK; }

EXPORT fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
  refresh(c);
  return fmi2OK;
}

EXPORT fmi2Status fmi2Terminate(fmi2Component c) { (void)c; return fmi2OK; }

EXPORT fmi2Status fmi2Reset(fmi2Component c) {
  reset(c);
  return fmi2OK;
}

EXPORT fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t n,
                              fmi2Real to[]) {
  Instance *m = c;
  refresh(m);
  for (size_t i = 0; i < n; i++) {
    if (r[i] >= ALL) return fmi2Error;
    to[i] = m->values[r[i]];
  }
  return fmi2OK;
}

EXPORT fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n,
                              const fmi2Real from[]) {
  Instance *m = c;
  for (size_t i = 0; i < n; i++) {
    if (r[i] >= ALL || (r[i] >= NX + NU && r[i] < NX + NU + NY)) return fmi2Error;
    if (!isfinite(from[i])) {
      say(m, fmi2Error, "logStatusError", "an input or a parameter is no finite number");
      return fmi2Error;
    }
  }
  for (size_t i = 0; i < n; i++) m->values[r[i]] = from[i];
  return fmi2OK;
}

EXPORT fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference r[], size_t n,
                                 fmi2Boolean to[]) {
  Instance *m = c;
  for (size_t i = 0; i < n; i++) {
    if (r[i] != FLAG) return fmi2Error;
    to[i] = m->unseen != 0;
  }
  return fmi2OK;
}

#define NONE(KIND, WORD) \\
  EXPORT fmi2Status fmi2Get##WORD(fmi2Component c, const fmi2ValueReference r[], size_t n, \\
                                  KIND to[]) { \\
    (void)c; (void)r; (void)to; \\
    return n ? fmi2Error : fmi2OK; \\
  }
#define FIXED(KIND, WORD) \\
  EXPORT fmi2Status fmi2Set##WORD(fmi2Component c, const fmi2ValueReference r[], size_t n, \\
                                  const KIND from[]) { \\
    (void)c; (void)r; (void)from; \\
    return n ? fmi2Error : fmi2OK; \\
  }
NONE(fmi2Integer, Integer)
NONE(fmi2String, String)
FIXED(fmi2Integer, Integer)
FIXED(fmi2Boolean, Boolean)
FIXED(fmi2String, String)

EXPORT fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *kept) {
  if (!*kept) *kept = malloc(sizeof(Instance));
  if (!*kept) return fmi2Error;
  memcpy(*kept, c, sizeof(Instance));
  return fmi2OK;
}

EXPORT fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate kept) {
  memcpy(c, kept, sizeof(Instance));
  return fmi2OK;
}

EXPORT fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *kept) {
  (void)c;
  free(*kept);
  *kept = NULL;
  return fmi2OK;
}

EXPORT fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate kept, size_t *n) {
  (void)c; (void)kept; (void)n;
  return fmi2Error;
}

EXPORT fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate kept, fmi2Byte to[],
                                        size_t n) {
  (void)c; (void)kept; (void)to; (void)n;
  return fmi2Error;
}

EXPORT fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte from[], size_t n,
                                          fmi2FMUstate *kept) {
  (void)c; (void)from; (void)n; (void)kept;
  return fmi2Error;
}

EXPORT fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference of[],
                                               size_t n, const fmi2ValueReference by[], size_t m,
                                               const fmi2Real d[], fmi2Real to[]) {
  (void)c; (void)of; (void)n; (void)by; (void)m; (void)d; (void)to;
  return fmi2Error;
}

EXPORT fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference r[],
                                              size_t n, const fmi2Integer order[],
                                              const fmi2Real from[]) {
  (void)c; (void)r; (void)n; (void)order; (void)from;
  return fmi2Error;
}

EXPORT fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference r[],
                                               size_t n, const fmi2Integer order[],
                                               fmi2Real to[]) {
  (void)c; (void)r; (void)n; (void)order; (void)to;
  return fmi2Error;
}

EXPORT fmi2Status fmi2DoStep(fmi2Component c, fmi2Real at, fmi2Real length, fmi2Boolean no_back) {
  Instance *m = c;
  double *v = m->values, *u = v + NX;
  int substeps = (int)ceil(length / $PERIOD - 1e-9);
  (void)no_back;
  int told = ${LOW}_step(v, u, u, v + NX + NU + NY, length, substeps < 1 ? 1 : substeps);
  if (told & (${UP}_WRONG | ${UP}_DIVERGED)) {
    say(m, fmi2Error, "logStatusError", told & ${UP}_WRONG
        ? "an input or the step is no number to go on"
        : "the ship left what the equations are for; the state is as before the step");
    return fmi2Error;
  }
  m->begun = 1;
  m->time = at + length;
  refresh(m);
  if (m->unseen && !m->told) {
    m->told = 1;
    say(m, fmi2Warning, "logStatusWarning",
        "beyond what the trials held: from here on the model is a guess");
  }
  return fmi2OK;
}

EXPORT fmi2Status fmi2CancelStep(fmi2Component c) { (void)c; return fmi2Error; }

#define STATUS(KIND, WORD) \\
  EXPORT fmi2Status fmi2Get##WORD(fmi2Component c, const fmi2StatusKind kind, KIND *to) { \\
    (void)c; (void)kind; (void)to; \\
    return fmi2Discard; \\
  }
STATUS(fmi2Status, Status)
STATUS(fmi2Real, RealStatus)
STATUS(fmi2Integer, IntegerStatus)
STATUS(fmi2Boolean, BooleanStatus)
STATUS(fmi2String, StringStatus)
"""

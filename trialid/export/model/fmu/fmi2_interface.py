"""FMI 2.0 for co-simulation in C: its types, so that no header has to be at hand, and its calls.

The names and types are those of the standard (FMI 2.0.4, `fmi2TypesPlatform.h`, `fmi2Functions.h`).
"""

from typing import Final

TYPES: Final = """\
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
typedef fmi2CallbackFunctions Listener;
"""

CALLS: Final = """\
static void say(Instance *m, int status, const char *words) {
  const char *category = status == FAILED ? "logStatusError" : "logStatusWarning";
  if (m->listener.logger)
    m->listener.logger(m->listener.environment, m->name, (fmi2Status)status, category, "%s", words);
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
  Instance *m = type == fmi2CoSimulation ? instance(name, guid) : NULL;
  if (m && calls) m->listener = *calls;
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
  return (fmi2Status)get(c, r, n, to);
}

EXPORT fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n,
                              const fmi2Real from[]) {
  return (fmi2Status)put(c, r, n, from);
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
  return (fmi2Status)keep(c, kept);
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
  (void)no_back;
  return (fmi2Status)advance(c, at, length);
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

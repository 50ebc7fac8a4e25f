"""FMI 3.0 for co-simulation in C: its types, so that no header has to be at hand, and its calls.

The names and types are those of the standard (FMI 3.0.2, `fmi3PlatformTypes.h`,
`fmi3FunctionTypes.h`). What the model has nothing of, other types, clocks, derivatives, is refused.
"""

from typing import Final

TYPES: Final = """\
#include <stdint.h>

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

typedef void *fmi3Instance, *fmi3InstanceEnvironment, *fmi3FMUState;
typedef unsigned int fmi3ValueReference;
typedef float fmi3Float32;
typedef double fmi3Float64;
typedef int8_t fmi3Int8;
typedef uint8_t fmi3UInt8, fmi3Byte;
typedef int16_t fmi3Int16;
typedef uint16_t fmi3UInt16;
typedef int32_t fmi3Int32;
typedef uint32_t fmi3UInt32;
typedef int64_t fmi3Int64;
typedef uint64_t fmi3UInt64;
typedef bool fmi3Boolean, fmi3Clock;
typedef const char *fmi3String;
typedef const fmi3Byte *fmi3Binary;
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef enum {
  fmi3Independent, fmi3Constant, fmi3Fixed, fmi3Tunable, fmi3Discrete, fmi3Dependent
} fmi3DependencyKind;
typedef enum {
  fmi3IntervalNotYetKnown, fmi3IntervalUnchanged, fmi3IntervalChanged
} fmi3IntervalQualifier;
typedef void (*fmi3LogMessageCallback)(fmi3InstanceEnvironment, fmi3Status, fmi3String, fmi3String);
typedef void (*fmi3IntermediateUpdateCallback)(fmi3InstanceEnvironment, fmi3Float64, fmi3Boolean,
                                               fmi3Boolean, fmi3Boolean, fmi3Boolean, fmi3Boolean *,
                                               fmi3Float64 *);
typedef void (*fmi3Callback)(void);
typedef void (*fmi3ClockUpdateCallback)(fmi3InstanceEnvironment);
typedef struct {
  fmi3LogMessageCallback tell;
  fmi3InstanceEnvironment environment;
} Listener;
"""

CALLS: Final = """\
static void say(Instance *m, int status, const char *words) {
  const char *category = status == FAILED ? "logStatusError" : "logStatusWarning";
  if (m->listener.tell)
    m->listener.tell(m->listener.environment, (fmi3Status)status, category, words);
}

EXPORT const char *fmi3GetVersion(void) { return "3.0"; }

EXPORT fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n,
                                      const fmi3String categories[]) {
  return fmi3OK;
}

EXPORT fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
    fmi3Boolean logging, fmi3Boolean events, fmi3Boolean early, const fmi3ValueReference needed[],
    size_t n, fmi3InstanceEnvironment environment, fmi3LogMessageCallback tell,
    fmi3IntermediateUpdateCallback update) {
  Instance *m = n ? NULL : instance(name, token);
  if (m) m->listener = (Listener){tell, environment};
  return m;
}

EXPORT fmi3Instance fmi3InstantiateModelExchange(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
    fmi3Boolean logging, fmi3InstanceEnvironment environment, fmi3LogMessageCallback tell) {
  return NULL;
}

EXPORT fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
    fmi3Boolean logging, fmi3InstanceEnvironment environment, fmi3LogMessageCallback tell,
    fmi3ClockUpdateCallback update, fmi3Callback lock, fmi3Callback unlock) {
  return NULL;
}

EXPORT void fmi3FreeInstance(fmi3Instance c) { free(c); }

EXPORT fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean tolerant,
                                              fmi3Float64 tolerance, fmi3Float64 from,
                                              fmi3Boolean ends, fmi3Float64 to) {
  ((Instance *)c)->time = from;
  return fmi3OK;
}

EXPORT fmi3Status fmi3ExitInitializationMode(fmi3Instance c) {
  refresh(c);
  return fmi3OK;
}

EXPORT fmi3Status fmi3EnterStepMode(fmi3Instance c) { return fmi3OK; }
EXPORT fmi3Status fmi3EnterConfigurationMode(fmi3Instance c) { return fmi3OK; }
EXPORT fmi3Status fmi3ExitConfigurationMode(fmi3Instance c) { return fmi3OK; }
EXPORT fmi3Status fmi3Terminate(fmi3Instance c) { return fmi3OK; }

EXPORT fmi3Status fmi3Reset(fmi3Instance c) {
  reset(c);
  return fmi3OK;
}

EXPORT fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n,
                                 fmi3Float64 to[], size_t size) {
  return size == n ? (fmi3Status)get(c, r, n, to) : fmi3Error;
}

EXPORT fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n,
                                 const fmi3Float64 from[], size_t size) {
  return size == n ? (fmi3Status)put(c, r, n, from) : fmi3Error;
}

EXPORT fmi3Status fmi3GetBoolean(fmi3Instance c, const fmi3ValueReference r[], size_t n,
                                 fmi3Boolean to[], size_t size) {
  Instance *m = c;
  for (size_t i = 0; i < n; i++) {
    if (r[i] != FLAG || size != n) return fmi3Error;
    to[i] = m->unseen != 0;
  }
  return fmi3OK;
}

EXPORT fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *kept) {
  return (fmi3Status)keep(c, kept);
}

EXPORT fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState kept) {
  memcpy(c, kept, sizeof(Instance));
  return fmi3OK;
}

EXPORT fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *kept) {
  free(*kept);
  *kept = NULL;
  return fmi3OK;
}

EXPORT fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 at, fmi3Float64 length,
                             fmi3Boolean no_back, fmi3Boolean *event, fmi3Boolean *ended,
                             fmi3Boolean *early, fmi3Float64 *last) {
  Instance *m = c;
  fmi3Status told = (fmi3Status)advance(m, at, length);
  *event = *ended = *early = false;
  *last = m->time;
  return told;
}

#define REFUSED(NAME, ...) \\
  EXPORT fmi3Status fmi3##NAME(fmi3Instance c, __VA_ARGS__) { return fmi3Error; }
#define REFERENCES const fmi3ValueReference r[], size_t n
#define NONE(KIND) \\
  EXPORT fmi3Status fmi3Get##KIND(fmi3Instance c, REFERENCES, fmi3##KIND to[], size_t size) { \\
    return n ? fmi3Error : fmi3OK; \\
  }
#define FIXED(KIND) \\
  EXPORT fmi3Status fmi3Set##KIND(fmi3Instance c, REFERENCES, const fmi3##KIND from[], \\
                                  size_t size) { \\
    return n ? fmi3Error : fmi3OK; \\
  }
#define NEITHER(KIND) NONE(KIND) FIXED(KIND)
NEITHER(Float32)
NEITHER(Int8)
NEITHER(UInt8)
NEITHER(Int16)
NEITHER(UInt16)
NEITHER(Int32)
NEITHER(UInt32)
NEITHER(Int64)
NEITHER(UInt64)
NEITHER(String)
FIXED(Boolean)
REFUSED(GetBinary, REFERENCES, size_t sizes[], fmi3Binary to[], size_t size)
REFUSED(SetBinary, REFERENCES, const size_t sizes[], const fmi3Binary from[], size_t size)
REFUSED(GetClock, REFERENCES, fmi3Clock to[])
REFUSED(SetClock, REFERENCES, const fmi3Clock from[])
REFUSED(GetNumberOfVariableDependencies, fmi3ValueReference of, size_t *n)
REFUSED(GetVariableDependencies, fmi3ValueReference of, size_t place[], fmi3ValueReference by[],
        size_t at[], fmi3DependencyKind kinds[], size_t n)
REFUSED(SerializedFMUStateSize, fmi3FMUState kept, size_t *n)
REFUSED(SerializeFMUState, fmi3FMUState kept, fmi3Byte to[], size_t n)
REFUSED(DeserializeFMUState, const fmi3Byte from[], size_t n, fmi3FMUState *kept)
#define SENSITIVITY const fmi3ValueReference of[], size_t n, const fmi3ValueReference by[], \\
                    size_t m, const fmi3Float64 seed[], size_t seeds, fmi3Float64 to[], size_t size
REFUSED(GetDirectionalDerivative, SENSITIVITY)
REFUSED(GetAdjointDerivative, SENSITIVITY)
REFUSED(GetIntervalDecimal, REFERENCES, fmi3Float64 to[], fmi3IntervalQualifier kinds[])
REFUSED(GetIntervalFraction, REFERENCES, fmi3UInt64 to[], fmi3UInt64 of[],
        fmi3IntervalQualifier kinds[])
REFUSED(GetShiftDecimal, REFERENCES, fmi3Float64 to[])
REFUSED(GetShiftFraction, REFERENCES, fmi3UInt64 to[], fmi3UInt64 of[])
REFUSED(SetIntervalDecimal, REFERENCES, const fmi3Float64 from[])
REFUSED(SetIntervalFraction, REFERENCES, const fmi3UInt64 from[], const fmi3UInt64 of[])
REFUSED(SetShiftDecimal, REFERENCES, const fmi3Float64 from[])
REFUSED(SetShiftFraction, REFERENCES, const fmi3UInt64 from[], const fmi3UInt64 of[])
REFUSED(UpdateDiscreteStates, fmi3Boolean *again, fmi3Boolean *ended, fmi3Boolean *nominals,
        fmi3Boolean *values, fmi3Boolean *next, fmi3Float64 *at)
REFUSED(GetOutputDerivatives, REFERENCES, const fmi3Int32 orders[], fmi3Float64 to[], size_t size)
REFUSED(CompletedIntegratorStep, fmi3Boolean no_back, fmi3Boolean *event, fmi3Boolean *ended)
REFUSED(SetTime, fmi3Float64 at)
REFUSED(SetContinuousStates, const fmi3Float64 x[], size_t n)
REFUSED(GetContinuousStates, fmi3Float64 x[], size_t n)
REFUSED(GetContinuousStateDerivatives, fmi3Float64 rates[], size_t n)
REFUSED(GetEventIndicators, fmi3Float64 to[], size_t n)
REFUSED(GetNominalsOfContinuousStates, fmi3Float64 to[], size_t n)
REFUSED(GetNumberOfEventIndicators, size_t *n)
REFUSED(GetNumberOfContinuousStates, size_t *n)
REFUSED(ActivateModelPartition, fmi3ValueReference clock, fmi3Float64 at)
EXPORT fmi3Status fmi3EnterEventMode(fmi3Instance c) { return fmi3Error; }
EXPORT fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c) { return fmi3Error; }
EXPORT fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance c) { return fmi3Error; }
"""

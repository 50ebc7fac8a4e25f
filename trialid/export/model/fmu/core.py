"""What an FMU does, in C, whichever version of FMI asks for it."""

from typing import Final

PLATFORM: Final = """\
#include <math.h>
#include <stdbool.h>
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
"""

CORE: Final = """\
enum { NX = $NX, NU = $NU, NY = $NY, NP = $NP, ALL = NX + NU + NY + NP };
enum { FLAG = ALL, TIME };

/* As both versions of FMI count them. */
enum { FINE = 0, WARNING = 1, FAILED = 3 };

/* Values by their references: states, inputs, what sensors show, parameters; behind them the flag
   that tells of what was not seen, and the time. */
typedef struct {
  double values[ALL + 1], time;
  int unseen, begun, told;
  Listener listener;
  char name[128];
} Instance;

static const double start[ALL + 1] = {$START};

static void say(Instance *m, int status, const char *words);

static void reset(Instance *m) {
  memcpy(m->values, start, sizeof start);
  m->time = 0.0;
  m->unseen = m->begun = m->told = 0;
}

static Instance *instance(const char *name, const char *token) {
  if (!token || strcmp(token, "$TOKEN")) return NULL;
  Instance *m = calloc(1, sizeof *m);
  if (!m) return NULL;
  if (name) strncpy(m->name, name, sizeof m->name - 1);
  reset(m);
  return m;
}

static void refresh(Instance *m) {
  double *v = m->values;
  ${LOW}_outputs(v, v + NX, v + NX + NU + NY, v + NX + NU);
  if (m->begun) m->unseen |= ${LOW}_unseen(v, v + NX);
}

static int get(Instance *m, const unsigned r[], size_t n, double to[]) {
  refresh(m);
  for (size_t i = 0; i < n; i++) {
    if (r[i] >= ALL && r[i] != TIME) return FAILED;
    to[i] = r[i] == TIME ? m->time : m->values[r[i]];
  }
  return FINE;
}

static int put(Instance *m, const unsigned r[], size_t n, const double from[]) {
  for (size_t i = 0; i < n; i++) {
    if (r[i] >= ALL || (r[i] >= NX + NU && r[i] < NX + NU + NY)) return FAILED;
    if (!isfinite(from[i])) {
      say(m, FAILED, "an input or a parameter is no finite number");
      return FAILED;
    }
  }
  for (size_t i = 0; i < n; i++) m->values[r[i]] = from[i];
  return FINE;
}

static int keep(const Instance *m, void **kept) {
  if (!*kept) *kept = malloc(sizeof(Instance));
  if (!*kept) return FAILED;
  memcpy(*kept, m, sizeof(Instance));
  return FINE;
}

static int advance(Instance *m, double at, double length) {
  double *v = m->values, *u = v + NX;
  int substeps = (int)ceil(length / $PERIOD - 1e-9);
  int told = ${LOW}_step(v, u, u, v + NX + NU + NY, length, substeps < 1 ? 1 : substeps);
  if (told & (${UP}_WRONG | ${UP}_DIVERGED)) {
    say(m, FAILED, told & ${UP}_WRONG
        ? "an input or the step is no number to go on"
        : "the ship left what the equations are for; the state is as before the step");
    return FAILED;
  }
  m->begun = 1;
  m->time = at + length;
  refresh(m);
  if (m->unseen && !m->told) {
    m->told = 1;
    say(m, WARNING, "beyond what the trials held: from here on the model is a guess");
  }
  return FINE;
}
"""

/* Status codes, ids, host hooks and version: what every other Loam header builds on. */
#ifndef LOAM_BASE_H
#define LOAM_BASE_H

#include <stddef.h>
#include <stdint.h>

#if defined(LOAM_STATIC)
#define LOAM_API
#elif defined(_WIN32)
#if defined(LOAM_BUILDING)
#define LOAM_API __declspec(dllexport)
#else
#define LOAM_API __declspec(dllimport)
#endif
#else
#define LOAM_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------------------------------------------- status --- */

/* What a call returns. LOAM_OK is 0; everything else is an error, and then the world is as it was before the call
 * unless the function says otherwise. Values never change meaning between versions. */
typedef int32_t loam_status;

enum {
  LOAM_OK = 0,
  LOAM_ERROR_INVALID_ARGUMENT = 1,    /* null, NaN, negative, out of range; the text names field, value and range */
  LOAM_ERROR_INVALID_HANDLE = 2,      /* the id is null, stale, or of another world */
  LOAM_ERROR_OUT_OF_MEMORY = 3,       /* the allocator refused; the text gives the bytes asked for */
  LOAM_ERROR_CAPACITY = 4,            /* a capacity of the world definition is too small; the text gives what is needed */
  LOAM_ERROR_BACKEND_UNAVAILABLE = 5, /* no such device or driver, or the library was built without that backend */
  LOAM_ERROR_IN_USE = 6,              /* the object is still referred to, or the buffers are mapped */
  LOAM_ERROR_INVALID_MESH = 7,        /* the mesh cannot serve this purpose; the text names the edge or triangle */
  LOAM_ERROR_DEVICE = 8,              /* the accelerator reported a failure; the world can only be destroyed */
  LOAM_ERROR_INTERNAL = 9,            /* a fault of the library; please report the text */
  LOAM_ERROR_INVALID_SNAPSHOT = 10,   /* not a snapshot, damaged, cut short, or of another version; the text says which */
  LOAM_ERROR_SNAPSHOT_MISMATCH =
      11,                    /* a snapshot of a world that was described otherwise; the text names the field that differs */
  LOAM_ERROR_BUSY = 12,      /* an asynchronous step was begun and not yet waited for */
  LOAM_ERROR_NOT_BUILT = 13, /* the library was built without this law or effect; the text names it */
  LOAM_ERROR_BUDGET = 14     /* a step took what stability needs, more than its budget; it was done. See accuracy.h */
};

/* A short constant name such as "LOAM_ERROR_CAPACITY"; "LOAM_ERROR_UNKNOWN" for a value that is not a status.
 * Any thread, any time. */
LOAM_API const char *loam_status_name(loam_status status);

/* The text of the last error of the calling thread: which argument, which value, what would be right. Empty if the last
 * call on this thread succeeded. Valid until the next Loam call on the same thread. Never null. */
LOAM_API const char *loam_last_error(void);

/* ------------------------------------------------------------------------------------------------------- ids --- */

/* What lives in a world is named by 64-bit ids: kind, world, generation and index. 0 is the null id. Ids are checked by every call:
 * one whose object is gone, or of another kind or world, gives LOAM_ERROR_INVALID_HANDLE, never another object. */
typedef uint64_t loam_material_id;
typedef uint64_t loam_collider_id;

/* ----------------------------------------------------------------------------------------------------- hooks --- */

/* Where the library takes host memory from. All null: the C++ runtime's aligned allocation. Either both functions are given or
 * neither. Calls come from the thread that calls Loam, or from the one that runs an asynchronous step; for one world, one at a time. `alignment` is a power of two, at most 4096. Return null to refuse:
 * the call in progress then fails with LOAM_ERROR_OUT_OF_MEMORY and leaves the world as it was. Bookkeeping of a few kilobytes
 * (names, error texts, id tables) does not pass through here. */
typedef struct loam_allocator {
  void *user;
  void *(*allocate)(void *user, size_t size, size_t alignment);
  void (*release)(void *user, void *memory, size_t size, size_t alignment);
} loam_allocator;

/* The host's own job system. All null: an internal one. Either both functions are given or neither.
 *
 * `enqueue` schedules `task(argument)` once, on any thread, at any later time, and returns a token for `finish`; it may also
 * run the task at once. `finish` returns when that task has returned (running it there and then is fine). During a step the
 * library enqueues at most thread_count - 1 tasks, works itself on the calling thread (that of the asynchronous step, if it is one), and finishes them before
 * it returns. The step also completes when no task is ever started before `finish`: late or missing help costs time, never correctness, and
 * never changes a result. */
typedef struct loam_job_system {
  void *user;
  void *(*enqueue)(void *user, void (*task)(void *argument), void *argument);
  void (*finish)(void *user, void *token);
} loam_job_system;

enum { LOAM_LOG_ERROR = 0, LOAM_LOG_WARNING = 1, LOAM_LOG_INFO = 2 };

/* Receives a line of text (no newline at its end, valid during the call) for each error and notable event of a world. Called on
 * the thread that called Loam. It must not call Loam. Null: silence; the library itself never prints. */
typedef struct loam_log {
  void *user;
  void (*message)(void *user, int32_t level, const char *text);
} loam_log;

/* --------------------------------------------------------------------------------------------------- version --- */

#define LOAM_VERSION_MAJOR 0
#define LOAM_VERSION_MINOR 1
#define LOAM_VERSION_PATCH 0

/* The version of the library that is loaded, to compare with the macros of the header. Any pointer may be null.
 * Any thread, any time. */
LOAM_API loam_status loam_version(uint32_t *major, uint32_t *minor, uint32_t *patch);

#ifdef __cplusplus
}
#endif

#endif

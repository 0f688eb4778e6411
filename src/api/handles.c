/* See handles.h. One mutex protects the whole table; it is held during look-ups only, not while a call works on an object. */
#include "handles.h"
#include <mfv.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>

/* Entry i uses the numbers i + MOST, i + 2 MOST, ... for successive handles. A handle is twice the number, plus 1: odd, unlike
 * addresses of objects. */
#define MOST ((uintptr_t)1 << (sizeof(uintptr_t) > 4 ? 22 : 14))
#define LAST_NUMBER (UINTPTR_MAX / 2 - MOST)

typedef struct entry {
  uintptr_t number;
  void *object; /* NULL: the entry is free */
  mfv_kind kind;
  int readers; /* calls that read the object now, or ALONE */
  uintptr_t next_free;
} entry;
enum { ALONE = -1 };

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static entry *table;
static uintptr_t size, first_free; /* first_free == size: there is no free entry */

/* Double the table, which is full. */
static void grow(void) {
  uintptr_t longer = size == 0 ? 64 : 2 * size;
  entry *grown = longer > MOST ? NULL : realloc(table, longer * sizeof *table);
  if (grown == NULL) return;
  for (uintptr_t i = size; i < longer; ++i) grown[i] = (entry){.number = i + MOST, .next_free = i + 1};
  table = grown;
  size = longer;
}

/* The entry of a handle, or NULL. */
static entry *find(const void *handle, mfv_kind kind) {
  uintptr_t number = (uintptr_t)handle / 2, i = number % MOST;
  int is_live = (uintptr_t)handle % 2 == 1 && i < size && table[i].number == number && table[i].object != NULL;
  return is_live && table[i].kind == kind ? &table[i] : NULL;
}

void *mfv_handle_issue(mfv_kind kind, void *object) {
  void *handle = NULL;
  pthread_mutex_lock(&lock);
  if (first_free == size) grow();
  if (first_free < size) {
    entry *taken = &table[first_free];
    first_free = taken->next_free;
    taken->object = object;
    taken->kind = kind;
    taken->readers = 0;
    handle = (void *)(2 * taken->number + 1);
  }
  pthread_mutex_unlock(&lock);
  return handle;
}

int mfv_handle_enter(const void *handle, mfv_kind kind, mfv_use use, void **object) {
  int status = MFV_BAD_HANDLE;
  pthread_mutex_lock(&lock);
  entry *found = find(handle, kind);
  if (found != NULL) {
    int is_busy = use == MFV_ALONE ? found->readers != 0 : found->readers == ALONE;
    status = is_busy ? MFV_IN_USE : MFV_COMPLETE;
    if (!is_busy) {
      found->readers = use == MFV_ALONE ? ALONE : found->readers + 1;
      *object = found->object;
    }
  }
  pthread_mutex_unlock(&lock);
  return status;
}

void mfv_handle_leave(const void *handle) {
  pthread_mutex_lock(&lock);
  entry *used = &table[(uintptr_t)handle / 2 % MOST];
  used->readers = used->readers == ALONE ? 0 : used->readers - 1;
  pthread_mutex_unlock(&lock);
}

int mfv_handle_remove(void **handle, mfv_kind kind, void **object) {
  int status = MFV_BAD_HANDLE;
  *object = NULL;
  if (handle == NULL || *handle == NULL) return MFV_COMPLETE;
  pthread_mutex_lock(&lock);
  entry *found = find(*handle, kind);
  if (found != NULL) status = found->readers == 0 ? MFV_COMPLETE : MFV_IN_USE;
  if (status == MFV_COMPLETE) {
    *object = found->object;
    found->object = NULL;
    if (found->number <= LAST_NUMBER) { /* else its numbers are used up */
      found->number += MOST;
      found->next_free = first_free;
      first_free = (uintptr_t)(found - table);
    }
  }
  pthread_mutex_unlock(&lock);
  if (status != MFV_IN_USE) *handle = NULL;
  return status;
}

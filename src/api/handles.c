/* See handles.h. The table grows by chunks that stay for ever, so that it is read without a lock; places are taken and given back
 * under one. */
#include "handles.h"
#include <mfv.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>

/* A handle has, from its lowest bit: 1, which no address of an object has; the index of the place; the tag. A tag has the sort in its
 * lowest two bits, above them the generation: how often the place has been given back. */
enum { INDEX_BITS = sizeof(uintptr_t) > 4 ? 22 : 14, SORT_BITS = 2, USERS_BITS = 16, CHUNK = 256 };
#define PLACES ((uintptr_t)1 << INDEX_BITS)
#define GENERATIONS ((uintptr_t)1 << (8 * sizeof(uintptr_t) - 1 - INDEX_BITS - SORT_BITS))

/* `state`: the tag, and below it how many calls read, or ALL_USERS where one is alone. */
#define ALL_USERS (((uint64_t)1 << USERS_BITS) - 1)

typedef struct place {
  _Atomic uint64_t state;
  void *object;
  uintptr_t index;
  struct place *next_free;
} place;

static _Atomic(place *) chunks[PLACES / CHUNK];
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static place *free_places;
static uintptr_t chunk_count;

/* One more chunk of free places, under the lock. */
static void grow(void) {
  if (chunk_count == PLACES / CHUNK) return;
  place *chunk = calloc(CHUNK, sizeof *chunk);
  if (chunk == NULL) return;
  for (uintptr_t i = CHUNK; i-- > 0;) {
    chunk[i].index = chunk_count * CHUNK + i;
    chunk[i].next_free = free_places;
    free_places = &chunk[i];
  }
  atomic_store(&chunks[chunk_count++], chunk);
}

void *mfv_handle_issue(mfv_sort sort, void *object) {
  pthread_mutex_lock(&lock);
  if (free_places == NULL) grow();
  place *taken = free_places;
  if (taken != NULL) free_places = taken->next_free;
  pthread_mutex_unlock(&lock);
  if (taken == NULL) return NULL;
  uint64_t tag = (atomic_load(&taken->state) >> USERS_BITS) | sort;
  taken->object = object;
  atomic_store(&taken->state, tag << USERS_BITS);
  return (void *)((((uintptr_t)tag << INDEX_BITS) | taken->index) << 1 | 1);
}

/* The place of a handle, and the tag that it says; NULL where the table has no such place. */
static place *place_of(const void *handle, uint64_t *tag) {
  uintptr_t number = (uintptr_t)handle;
  uintptr_t index = (number >> 1) & (PLACES - 1);
  *tag = number >> 1 >> INDEX_BITS;
  if ((number & 1) == 0) return NULL;
  place *chunk = atomic_load(&chunks[index / CHUNK]);
  return chunk == NULL ? NULL : &chunk[index % CHUNK];
}

int mfv_handle_enter(const void *handle, mfv_sort sort, mfv_use use, void **object) {
  uint64_t tag;
  place *there = place_of(handle, &tag);
  if (there == NULL || (tag & ((1 << SORT_BITS) - 1)) != sort) return MFV_BAD_HANDLE;
  uint64_t now = atomic_load(&there->state), then;
  do {
    uint64_t users = now & ALL_USERS;
    if (now >> USERS_BITS != tag) return MFV_BAD_HANDLE;
    if (use == MFV_ALONE ? users > 0 : users + 1 >= ALL_USERS) return MFV_IN_USE;
    then = use == MFV_ALONE ? now | ALL_USERS : now + 1;
  } while (!atomic_compare_exchange_weak(&there->state, &now, then));
  *object = there->object;
  return MFV_COMPLETE;
}

void mfv_handle_leave(const void *handle) {
  uint64_t tag;
  place *there = place_of(handle, &tag);
  if ((atomic_load(&there->state) & ALL_USERS) == ALL_USERS)
    atomic_store(&there->state, tag << USERS_BITS);
  else
    atomic_fetch_sub(&there->state, 1);
}

void mfv_handle_withdraw(const void *handle) {
  uint64_t tag;
  place *there = place_of(handle, &tag);
  uint64_t generation = (tag >> SORT_BITS) + 1;
  there->object = NULL;
  atomic_store(&there->state, generation << SORT_BITS << USERS_BITS);
  if (generation == GENERATIONS) return; /* its handles are used up: it is not given out again */
  pthread_mutex_lock(&lock);
  there->next_free = free_places;
  free_places = there;
  pthread_mutex_unlock(&lock);
}

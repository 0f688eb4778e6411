/* OpenMP as far as mfv_sweep uses it, made of POSIX threads. GCC's own synchronises by system calls that race checkers do not
 * see, so that they take everything it guards for a race. To be loaded before it (LD_PRELOAD): scripts/deep-races.sh. */
#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

static _Thread_local int number_of_thread = 0, threads_of_team = 1;

typedef struct {
  void (*work)(void *);
  void *data;
  int number, threads;
} member;

static void *begin(void *argument) {
  const member *self = argument;
  number_of_thread = self->number;
  threads_of_team = self->threads;
  self->work(self->data);
  return NULL;
}

void GOMP_parallel(void (*work)(void *), void *data, unsigned threads, unsigned flags);
void GOMP_parallel(void (*work)(void *), void *data, unsigned threads, unsigned flags) {
  pthread_t *ids = malloc(threads * sizeof *ids);
  member *members = malloc(threads * sizeof *members);
  (void)flags;
  if (ids == NULL || members == NULL) abort();
  for (unsigned i = 0; i < threads; i++) members[i] = (member){work, data, (int)i, (int)threads};
  for (unsigned i = 1; i < threads; i++) {
    if (pthread_create(&ids[i], NULL, begin, &members[i]) != 0) abort();
  }
  begin(&members[0]);
  for (unsigned i = 1; i < threads; i++) pthread_join(ids[i], NULL);
  number_of_thread = 0;
  threads_of_team = 1;
  free(ids);
  free(members);
}

/* A named critical section brings room for a pointer, null in the beginning. */
static pthread_mutex_t making = PTHREAD_MUTEX_INITIALIZER;

static pthread_mutex_t *mutex_of(void **room) {
  pthread_mutex_lock(&making);
  if (*room == NULL) {
    *room = malloc(sizeof(pthread_mutex_t));
    if (*room == NULL || pthread_mutex_init(*room, NULL) != 0) abort();
  }
  pthread_mutex_t *mutex = *room;
  pthread_mutex_unlock(&making);
  return mutex;
}

void GOMP_critical_name_start(void **room);
void GOMP_critical_name_start(void **room) { pthread_mutex_lock(mutex_of(room)); }
void GOMP_critical_name_end(void **room);
void GOMP_critical_name_end(void **room) { pthread_mutex_unlock(mutex_of(room)); }

int omp_get_thread_num_(void);
int omp_get_thread_num_(void) { return number_of_thread; }
int omp_get_num_threads_(void);
int omp_get_num_threads_(void) { return threads_of_team; }
int omp_get_num_procs_(void);
int omp_get_num_procs_(void) { return (int)sysconf(_SC_NPROCESSORS_ONLN); }
int omp_get_max_threads_(void);
int omp_get_max_threads_(void) { return omp_get_num_procs_(); }
void omp_set_dynamic_(const int *dynamic);
void omp_set_dynamic_(const int *dynamic) { (void)dynamic; }

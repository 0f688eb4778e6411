/* Opening HDF5's Fortran interface once. In C because PTHREAD_ONCE_INIT is a macro. */
#include <pthread.h>

void mfv_open_hdf5(void);

static pthread_once_t opened = PTHREAD_ONCE_INIT;

/* Call mfv_open_hdf5 once; other threads wait until it has returned. */
void mfv_open_hdf5_once(void) { pthread_once(&opened, mfv_open_hdf5); }

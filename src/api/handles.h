/* The table of live handles. A handle is a number, not an address: the place of its entry in a table, and how often that place has
 * been given out. So a handle that is null, was freed, is of another sort or was never given out is told without
 * looking where it points. */
#ifndef MFV_HANDLES_H
#define MFV_HANDLES_H

/* What a handle is of; 0 is what a free place is of. */
typedef enum { MFV_SORT_SCENE = 1, MFV_SORT_CASE, MFV_SORT_STATE } mfv_sort;

/* How a call uses what a handle is of: alone, or only reading, as others may at the same time. */
typedef enum { MFV_ALONE, MFV_READING } mfv_use;

/* A handle of an object; NULL where there is no memory for one more. */
void *mfv_handle_issue(mfv_sort sort, void *object);

/* Begin to use what a handle is of: *object. MFV_BAD_HANDLE; MFV_IN_USE where another call uses it. */
int mfv_handle_enter(const void *handle, mfv_sort sort, mfv_use use, void **object);

/* End the use. */
void mfv_handle_leave(const void *handle);

/* End the use, and the handle with it: no later one is the same. */
void mfv_handle_withdraw(const void *handle);

#endif

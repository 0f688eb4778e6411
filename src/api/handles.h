/* The table of live handles. A handle is a number, not an address: it is looked up, and nothing is read where it points. Numbers are
 * never reused, so a handle that is null, was freed, is of another kind or was made up is always detected.
 * src/api/handles.f90 has the same for Fortran. */
#ifndef MFV_HANDLES_H
#define MFV_HANDLES_H

/* What a handle stands for. */
typedef enum { MFV_KIND_SCENE = 1, MFV_KIND_CASE, MFV_KIND_STATE } mfv_kind;

/* How a call uses the object of a handle: no other call may use it meanwhile, or others may read it, too. */
typedef enum { MFV_ALONE, MFV_READING } mfv_use;

/* A new handle of an object; NULL if the table has no room for it. */
void *mfv_handle_issue(mfv_kind kind, void *object);

/* Look a handle up and mark it as in use: *object. MFV_BAD_HANDLE; MFV_IN_USE during another call on it. */
int mfv_handle_enter(const void *handle, mfv_kind kind, mfv_use use, void **object);

/* End the use. */
void mfv_handle_leave(const void *handle);

/* Remove *handle from the table and set it to NULL; *object is what it stood for, to be freed, else NULL. No harm if `handle` or
 * *handle is NULL. MFV_BAD_HANDLE; MFV_IN_USE, which leaves everything as it is. */
int mfv_handle_remove(void **handle, mfv_kind kind, void **object);

#endif

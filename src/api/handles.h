/* The table of live handles. A handle is a number, not an address, and is never reused: a handle that is null, freed, of another
 * kind or invalid is always detected. Fortran interface: src/api/handles.f90. */
#ifndef MFV_HANDLES_H
#define MFV_HANDLES_H

/* What a handle stands for. */
typedef enum { MFV_KIND_SCENE = 1, MFV_KIND_CASE, MFV_KIND_STATE } mfv_kind;

/* Use of an object by a call: exclusive, or shared with other readers. */
typedef enum { MFV_ALONE, MFV_READING } mfv_use;

/* A new handle of an object; NULL if the table has no room for it. */
void *mfv_handle_issue(mfv_kind kind, void *object);

/* Look up the object of a handle and mark it as in use. MFV_BAD_HANDLE; MFV_IN_USE during another call on it. */
int mfv_handle_enter(const void *handle, mfv_kind kind, mfv_use use, void **object);

/* End the use. */
void mfv_handle_leave(const void *handle);

/* Remove *handle from the table and set it to NULL; *object: its object, to be freed, or NULL. Safe if `handle` or *handle is NULL.
 * MFV_BAD_HANDLE; MFV_IN_USE, which changes nothing. */
int mfv_handle_remove(void **handle, mfv_kind kind, void **object);

#endif

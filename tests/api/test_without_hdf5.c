/* The C interface where MFV is built without HDF5: everything but files is there, and of files messages tell why they are not.
 * Usage: test_without_hdf5 CASE.nml. Prints what failed; exit code 0 when nothing did. */
#include "check.h"
#include <mfv.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static const char *const with_a_matrix =
  "&body shape='matrix', file='body.h5' /\n&body shape='disk', radius=1, rigid=.true. /\n&step normal_force=1 /\n";

int main(int argc, char **argv) {
  mfv_case *handle = NULL;
  char message[400] = "";
  int32_t nodes = 0;
  int there = 1;
  if (argc != 2) {
    fprintf(stderr, "usage: test_without_hdf5 CASE.nml\n");
    return 2;
  }
  CHECK(mfv_has_feature("hdf5", &there) == MFV_COMPLETE && there == 0);
  CHECK(mfv_create_from_file(argv[1], &handle, NULL, 0) == MFV_COMPLETE);
  CHECK(mfv_run(handle) == MFV_COMPLETE);
  CHECK(mfv_copy_integer(handle, "summary/contact_nodes", &nodes, 1) == MFV_COMPLETE && nodes == 87);
  CHECK(mfv_write(handle, "without_hdf5.h5") == MFV_FILE_ERROR);
  CHECK(mfv_message(handle, message, sizeof message) == MFV_COMPLETE);
  CHECK(strstr(message, "without_hdf5.h5") != NULL && strstr(message, "MFV_HDF5=OFF") != NULL);
  CHECK(mfv_free(&handle) == MFV_COMPLETE);

  CHECK(mfv_create_from_text(with_a_matrix, "text", &handle, message, sizeof message) == MFV_INPUT_ERROR);
  CHECK(strstr(message, "body.h5") != NULL && strstr(message, "MFV_HDF5=OFF") != NULL);
  if (failures > 0) printf("without HDF5: %d checks failed, last message: %s\n", failures, message);
  if (failures == 0) printf("without HDF5: all checks passed\n");
  return failures != 0;
}

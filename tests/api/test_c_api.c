/* The C interface as a host program uses it. Usage: test_c_api CASE.nml RESULT.h5. Prints what failed; exit code 0 when
 * nothing did. */
#include "check.h"
#include <math.h>
#include <mfv.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
#include <malloc.h>
#define BYTES_IN_USE() ((double)mallinfo2().uordblks)
#else
#define BYTES_IN_USE() 0.0
#endif

#define SCENE                                                                                    \
  "&scene coupling='goodman' / &body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /\n" \
  "&body shape='disk', radius=0.25, rigid=.true. / &mesh nodes=41, half_width=0.0127 /\n"        \
  "&friction law='coulomb', mu=0.7 /\n"
static const char *const without_steps = SCENE;
static const char *const text = SCENE "&step normal_force=1.0e-3, friction=.false. / &step tangential_force=2.8e-4 /\n";

static double scalar(const mfv_case *handle, const char *path) {
  double value = NAN;
  CHECK(mfv_copy_real(handle, path, &value, 1) == MFV_COMPLETE);
  return value;
}

static double *array(const mfv_case *handle, const char *path, size_t *count) {
  int is_integer = -1, along = -1;
  char unit[40], description[200];
  CHECK(mfv_field_info(handle, path, count, &is_integer, &along, unit, sizeof unit, description, sizeof description) == MFV_COMPLETE);
  CHECK(is_integer == 0 && along == MFV_ALONG_NODES && strlen(unit) > 0 && strlen(description) > 0);
  double *values = malloc(*count * sizeof *values);
  CHECK(mfv_copy_real(handle, path, values, *count) == MFV_COMPLETE);
  return values;
}

static void run_a_file(const char *case_file, const char *result_file) {
  mfv_case *handle = NULL;
  char message[400] = "";
  int32_t nodes = 0;
  CHECK(mfv_create_from_file(case_file, &handle, message, sizeof message) == MFV_COMPLETE);
  CHECK(handle != NULL && strcmp(message, "") == 0);
  CHECK(mfv_run(handle) == MFV_COMPLETE);
  CHECK(mfv_copy_integer(handle, "summary/contact_nodes", &nodes, 1) == MFV_COMPLETE);
  CHECK(nodes == 87);
  CHECK(scalar(handle, "certificate/largest") < 1e-10);
  CHECK(mfv_write(handle, result_file) == MFV_COMPLETE);
  FILE *file = fopen(result_file, "rb");
  CHECK(file != NULL);
  if (file != NULL) fclose(file);
  CHECK(mfv_write(handle, "no/such/folder/x.h5") == MFV_FILE_ERROR);
  CHECK(mfv_message(handle, message, sizeof message) == MFV_COMPLETE);
  CHECK(strstr(message, "no/such/folder/x.h5") != NULL);
  CHECK(mfv_free(&handle) == MFV_COMPLETE && handle == NULL);
}

/* Files that are written again and again leave no memory in use behind (60 kB each, when HDF5 was opened for each of them). */
static void writing_keeps_no_memory(const char *result_file) {
  enum { TIMES = 20 };
  mfv_case *handle = NULL;
  double before = 0;
  CHECK(mfv_create_from_text(text, "text", &handle, NULL, 0) == MFV_COMPLETE && mfv_run(handle) == MFV_COMPLETE);
  for (int i = -5; i < TIMES; ++i) {
    if (i == 0) before = BYTES_IN_USE();
    CHECK(mfv_write(handle, result_file) == MFV_COMPLETE);
  }
  CHECK(BYTES_IN_USE() - before < TIMES * 4000.0);
  mfv_free(&handle);
}

static void step_by_step_equals_run(void) {
  mfv_case *whole = NULL, *stepped = NULL;
  size_t count = 0, same = 0;
  CHECK(mfv_create_from_text(text, "text", &whole, NULL, 0) == MFV_COMPLETE);
  CHECK(mfv_create_from_text(without_steps, NULL, &stepped, NULL, 0) == MFV_COMPLETE);
  CHECK(mfv_run(whole) == MFV_COMPLETE);

  mfv_step press = MFV_STEP_INIT, shear = MFV_STEP_INIT;
  press.control[MFV_APPROACH] = MFV_FORCE;
  press.target[MFV_APPROACH] = 1.0e-3;
  press.friction = 0;
  shear.control[MFV_SHIFT] = MFV_FORCE;
  shear.target[MFV_SHIFT] = 2.8e-4;
  CHECK(mfv_advance(stepped, &press) == MFV_COMPLETE);
  CHECK(mfv_advance(stepped, &shear) == MFV_COMPLETE);
  double *a = array(whole, "state/shear", &count), *b = array(stepped, "state/shear", &same);
  CHECK(count == 41 && same == 41 && memcmp(a, b, count * sizeof *a) == 0);
  free(a);
  free(b);

  shear.target[MFV_SHIFT] = 8.0e-4;
  CHECK(mfv_advance(stepped, &shear) == MFV_GROSS_SLIDING);
  CHECK(fabs(scalar(stepped, "summary/tangential_force") / 7.0e-4 - 1) < 1e-9);
  CHECK(mfv_advance(stepped, &press) == MFV_GROSS_SLIDING);
  mfv_free(&whole);
  mfv_free(&stepped);
}

static void every_field_can_be_copied(void) {
  mfv_case *handle = NULL;
  size_t fields = 0;
  CHECK(mfv_create_from_text(text, "text", &handle, NULL, 0) == MFV_COMPLETE);
  CHECK(mfv_run(handle) == MFV_COMPLETE);
  CHECK(mfv_field_count(handle, &fields) == MFV_COMPLETE && fields > 50);
  for (size_t i = 0; i < fields; ++i) {
    char path[100];
    size_t count = 0;
    int is_integer = 0;
    CHECK(mfv_field_path(handle, i, path, sizeof path) == MFV_COMPLETE);
    CHECK(mfv_field_info(handle, path, &count, &is_integer, NULL, NULL, 0, NULL, 0) == MFV_COMPLETE);
    CHECK(count > 0);
    if (is_integer) {
      int32_t *values = malloc(count * sizeof *values);
      CHECK(mfv_copy_integer(handle, path, values, count) == MFV_COMPLETE);
      free(values);
    } else {
      double *values = malloc(count * sizeof *values);
      CHECK(mfv_copy_real(handle, path, values, count) == MFV_COMPLETE);
      free(values);
    }
  }
  mfv_free(&handle);
}

static void attributes_are_texts(void) {
  mfv_case *handle = NULL;
  size_t length = 0;
  char buffer[20];
  CHECK(mfv_create_from_text(text, "text", &handle, NULL, 0) == MFV_COMPLETE);
  CHECK(mfv_attribute(handle, "input", NULL, 0, &length) == MFV_COMPLETE && length == strlen(text));
  CHECK(mfv_attribute(handle, "coupling", buffer, sizeof buffer, NULL) == MFV_COMPLETE && strcmp(buffer, "goodman") == 0);
  CHECK(mfv_attribute(handle, "upper_body", buffer, sizeof buffer, NULL) == MFV_COMPLETE && strcmp(buffer, "rigid disk") == 0);
  mfv_free(&handle);
}

static void misuse_is_told(void) {
  mfv_case *handle = NULL;
  char message[400] = "", tiny[4] = "";
  double value = 0;
  int32_t whole = 0;
  CHECK(mfv_create_from_file("no/such/case.nml", &handle, message, sizeof message) == MFV_INPUT_ERROR);
  CHECK(handle == NULL && strstr(message, "no/such/case.nml") != NULL);
  CHECK(mfv_create_from_text("&body radius=-1 /", "here", &handle, tiny, sizeof tiny) == MFV_INPUT_ERROR);
  CHECK(strcmp(tiny, "her") == 0);
  CHECK(mfv_create_from_file(NULL, &handle, NULL, 0) == MFV_BAD_ARGUMENT);
  CHECK(mfv_run(NULL) == MFV_BAD_HANDLE);
  CHECK(mfv_message(NULL, message, sizeof message) == MFV_BAD_HANDLE);
  CHECK(mfv_free(NULL) == MFV_COMPLETE);
  CHECK(mfv_free(&handle) == MFV_COMPLETE);

  CHECK(mfv_create_from_text(text, "text", &handle, NULL, 0) == MFV_COMPLETE);
  CHECK(mfv_copy_real(handle, "state/presure", &value, 1) == MFV_BAD_ARGUMENT);
  CHECK(mfv_message(handle, message, sizeof message) == MFV_COMPLETE && strstr(message, "state/presure") != NULL);
  CHECK(mfv_copy_real(handle, "state/pressure", &value, 1) == MFV_BAD_ARGUMENT);
  CHECK(mfv_copy_real(handle, "summary/contact_nodes", &value, 1) == MFV_BAD_ARGUMENT);
  CHECK(mfv_copy_integer(handle, "summary/shift", &whole, 1) == MFV_BAD_ARGUMENT);
  CHECK(mfv_copy_real(handle, NULL, &value, 1) == MFV_BAD_ARGUMENT);
  CHECK(mfv_advance(handle, NULL) == MFV_BAD_ARGUMENT);
  mfv_step step = MFV_STEP_INIT;
  step.control[MFV_APPROACH] = 7;
  CHECK(mfv_advance(handle, &step) == MFV_BAD_ARGUMENT);
  step.control[MFV_APPROACH] = MFV_FORCE;
  step.target[MFV_APPROACH] = -1;
  CHECK(mfv_advance(handle, &step) == MFV_BAD_ARGUMENT);
  step.target[MFV_APPROACH] = NAN;
  CHECK(mfv_advance(handle, &step) == MFV_BAD_ARGUMENT);
  step.size = 3;
  CHECK(mfv_advance(handle, &step) == MFV_BAD_ARGUMENT);
  CHECK(mfv_write(handle, NULL) == MFV_BAD_ARGUMENT);
  CHECK(mfv_field_path(handle, 9999, message, sizeof message) == MFV_BAD_ARGUMENT);
  CHECK(mfv_attribute(handle, "colour", message, sizeof message, NULL) == MFV_BAD_ARGUMENT);
  CHECK(mfv_copy_real(handle, "state/pressure", &value, 1) == MFV_BAD_ARGUMENT);
  CHECK(mfv_message(handle, message, sizeof message) == MFV_COMPLETE && strstr(message, "has 41 values") != NULL);
  mfv_free(&handle);
}

static void statuses_and_version(void) {
  char outcome[60], explanation[200], version[20] = "";
  for (int status = 0; status < MFV_STATUS_COUNT; ++status)
    CHECK(mfv_status_text(status, outcome, sizeof outcome, explanation, sizeof explanation) == MFV_COMPLETE);
  CHECK(mfv_status_text(MFV_STATUS_COUNT, outcome, sizeof outcome, explanation, sizeof explanation) == MFV_BAD_ARGUMENT);
  CHECK(mfv_status_text(MFV_GROSS_SLIDING, outcome, sizeof outcome, NULL, 0) == MFV_BAD_ARGUMENT);
  CHECK(strcmp(outcome, "gross sliding") == 0);
  CHECK(mfv_version(version, sizeof version) == MFV_COMPLETE && strcmp(version, MFV_EXPECTED_VERSION) == 0);
  CHECK(mfv_version(NULL, 3) == MFV_BAD_ARGUMENT);
}

/* A closed form of up to five numbers. */
static double form(const char *name, size_t count, double a, double b, double c, double d, double e) {
  const double numbers[] = {a, b, c, d, e};
  double value = 0;
  CHECK(mfv_reference(name, count, numbers, &value) == MFV_COMPLETE);
  return value;
}

static void closed_forms(void) {
  double a = form("hertz_half_width", 4, 1e-3, 0.25, 1.0, 1.8, 0);
  CHECK(fabs(a - sqrt(1e-3 * 2.8 * 0.25 / (2 * 3.14159265358979323846))) < 1e-16);
  CHECK(fabs(form("mindlin_stick_ratio", 3, 2.8e-4, 1e-3, 0.7, 0, 0) - sqrt(0.6)) < 1e-15);
  CHECK(form("mindlin_shear", 5, 0.0, 2.8e-4, 1e-3, a, 0.7) > 0);
  CHECK(form("spence_stick_ratio", 2, 0.3, 0.0, 0, 0, 0) == 1.0);
  CHECK(form("spence_cylinder_shear", 5, 0.5 * a, 1e-3, a, 0.3, 0.2) > 0);
  CHECK(form("spence_flat_punch_shear", 5, -0.5 * a, 1e-3, a, 0.3, 0.2) < 0);
  CHECK(form("mindlin_dissipation", 5, 2.8e-4, 1e-3, a, 0.25, 0.7) > 0);
  CHECK(isnan(form("hertz_half_width", 4, -1.0, 0.25, 1.0, 1.8, 0)));
  CHECK(isnan(form("hertz_pressure", 3, 0.0, 1.0, 0.0, 0, 0)));
  CHECK(isnan(form("flat_punch_pressure", 3, 0.0, 1.0, -1.0, 0, 0)));
  CHECK(isnan(form("spence_stick_ratio", 2, -0.1, 0.2, 0, 0, 0)));
}

/* Stresses on the surface are the tractions; the largest is no smaller than any inside the body; misuse is reported. */
static void stresses_inside(void) {
  mfv_case *handle = NULL;
  size_t nodes = 0;
  double stress[2 * MFV_STRESS_COUNT], place[3] = {0, 0, 0}, again[3];
  CHECK(mfv_create_from_text(text, "text", &handle, NULL, 0) == MFV_COMPLETE);
  CHECK(mfv_run(handle) == MFV_COMPLETE);
  double *x = array(handle, "mesh/x", &nodes), *width = array(handle, "mesh/width", &nodes);
  double *pressure = array(handle, "state/pressure", &nodes), *shear = array(handle, "state/shear", &nodes);
  const double across[2] = {x[20], 0.001}, up[2] = {0.0, -0.008};
  CHECK(mfv_stress(handle, MFV_LOWER, 0, 2, across, up, stress, NULL, NULL) == MFV_COMPLETE);
  CHECK(fabs(stress[MFV_SIGMA_YY] / pressure[20] + 1) < 5e-3 && fabs(stress[MFV_SIGMA_XY] / shear[20] - 1) < 1e-2);
  CHECK(isnan(stress[MFV_SIGMA_RR]) && stress[MFV_PRINCIPAL_1] >= stress[MFV_PRINCIPAL_2]);
  CHECK(mfv_stress(handle, MFV_LOWER, 1, 0, NULL, NULL, NULL, place, NULL) == MFV_COMPLETE);
  CHECK(place[0] > stress[MFV_STRESS_COUNT + MFV_VON_MISES] / 2 && place[2] < 0 && fabs(place[1]) < 1e-4);
  CHECK(mfv_stress(handle, MFV_LOWER, 0, 0, NULL, NULL, NULL, place, NULL) == MFV_COMPLETE);
  double *contact_edge = array(handle, "state/contact_edge", &nodes), *stick_edge = array(handle, "state/stick_edge", &nodes);
  CHECK(mfv_stress_under(handle, MFV_LOWER, nodes, x, width, pressure, shear, contact_edge, stick_edge, 0.0, 0, NULL, NULL, NULL, again,
                         NULL) == MFV_COMPLETE);
  CHECK(memcmp(place, again, sizeof place) == 0);
  CHECK(mfv_stress(handle, MFV_LOWER, 0, 0, NULL, NULL, NULL, NULL, place) == MFV_COMPLETE && place[0] > 0 && place[2] == 0);
  CHECK(mfv_stress_under(handle, MFV_LOWER, nodes, x, width, pressure, shear, contact_edge, stick_edge, 0.0, 0, NULL, NULL, NULL, NULL,
                         again) == MFV_COMPLETE);
  CHECK(memcmp(place, again, sizeof place) == 0);
  free(contact_edge);
  free(stick_edge);
  CHECK(mfv_stress(handle, MFV_UPPER, 0, 2, across, up, stress, NULL, NULL) == MFV_BAD_ARGUMENT);
  CHECK(mfv_stress(handle, 2, 0, 2, across, up, stress, NULL, NULL) == MFV_BAD_ARGUMENT);
  CHECK(mfv_stress(handle, MFV_LOWER, 3, 2, across, up, stress, NULL, NULL) == MFV_BAD_ARGUMENT);
  CHECK(mfv_stress(handle, MFV_LOWER, 0, 2, NULL, up, stress, NULL, NULL) == MFV_BAD_ARGUMENT);
  CHECK(mfv_stress(NULL, MFV_LOWER, 0, 2, across, up, stress, NULL, NULL) == MFV_BAD_HANDLE);
  free(x);
  free(width);
  free(pressure);
  free(shear);
  CHECK(mfv_free(&handle) == MFV_COMPLETE);
}

/* A moment by steps, and back. */
static void moment_and_rotation(void) {
  mfv_case *handle = NULL;
  mfv_step press = MFV_STEP_INIT, turn = MFV_STEP_INIT;
  CHECK(mfv_create_from_text(without_steps, NULL, &handle, NULL, 0) == MFV_COMPLETE);
  press.control[MFV_APPROACH] = MFV_FORCE;
  press.target[MFV_APPROACH] = 5.0e-4;
  CHECK(mfv_advance(handle, &press) == MFV_COMPLETE);
  turn.control[MFV_ROTATION] = MFV_FORCE;
  turn.target[MFV_ROTATION] = 5.0e-7;
  CHECK(mfv_advance(handle, &turn) == MFV_COMPLETE);
  CHECK(fabs(scalar(handle, "summary/moment") / 5.0e-7 - 1) < 1e-10 && scalar(handle, "summary/rotation") > 0);
  turn.control[MFV_ROTATION] = 7;
  CHECK(mfv_advance(handle, &turn) == MFV_BAD_ARGUMENT);
  CHECK(mfv_free(&handle) == MFV_COMPLETE);
}

int main(int argc, char **argv) {
  if (argc != 3) {
    fprintf(stderr, "usage: test_c_api CASE.nml RESULT.h5\n");
    return 2;
  }
  run_a_file(argv[1], argv[2]);
  writing_keeps_no_memory(argv[2]);
  step_by_step_equals_run();
  every_field_can_be_copied();
  attributes_are_texts();
  misuse_is_told();
  stresses_inside();
  moment_and_rotation();
  statuses_and_version();
  closed_forms();
  printf(failures == 0 ? "C interface: all checks passed\n" : "C interface: %d checks failed\n", failures);
  return failures != 0;
}

/* A rigid cylinder is pressed on an elastic half-plane without friction and then sheared. */
#include <mfv.h>
#include <stdio.h>
#include <stdlib.h>

enum { NODES = 101 };

static int fail(const char *message) {
  fprintf(stderr, "%s\n", message);
  return EXIT_FAILURE;
}

int main(void) {
  mfv_scene *scene = NULL;
  mfv_case *contact = NULL;
  mfv_step press = MFV_STEP_INIT, shear = MFV_STEP_INIT;
  mfv_loads loads = MFV_LOADS_INIT;
  char message[500] = "out of memory";
  double traction[NODES], peak = 0.0;

  mfv_scene_create(&scene);
  mfv_scene_set_text(scene, "body(1)%shape", "half_plane");
  mfv_scene_set_real(scene, "body(1)%shear_modulus", 1.0);
  mfv_scene_set_real(scene, "body(1)%poisson_ratio", 0.3);
  mfv_scene_set_text(scene, "body(2)%shape", "disk");
  mfv_scene_set_real(scene, "body(2)%radius", 0.25);
  mfv_scene_set_logical(scene, "body(2)%rigid", 1);
  mfv_scene_set_integer(scene, "mesh%nodes", NODES);
  mfv_scene_set_real(scene, "mesh%half_width", 0.0125);
  mfv_scene_set_text(scene, "friction%law", "coulomb");
  mfv_scene_set_real(scene, "friction%mu", 0.7);
  int status = mfv_create(scene, &contact, message, sizeof message); /* errors of the scene are reported here */
  mfv_scene_free(&scene);
  if (status != MFV_COMPLETE) return fail(message);

  press.control[MFV_APPROACH] = MFV_FORCE;
  press.target[MFV_APPROACH] = 1.0e-3;
  press.friction = 0;
  shear.control[MFV_SHIFT] = MFV_FORCE;
  shear.target[MFV_SHIFT] = 2.8e-4;
  status = mfv_advance(contact, &press);
  if (status == MFV_COMPLETE) status = mfv_advance(contact, &shear);
  if (status == MFV_COMPLETE) status = mfv_get_loads(contact, &loads);
  if (status == MFV_COMPLETE) status = mfv_copy_real(contact, "state/shear", traction, NODES);
  mfv_message(contact, message, sizeof message); /* what was reached, or why the run ended early */
  mfv_free(&contact);
  if (status != MFV_COMPLETE) return fail(message);

  for (int i = 0; i < NODES; ++i)
    if (traction[i] > peak) peak = traction[i];
  printf("nodes in contact %d, stuck %d\n", loads.contact_nodes, loads.stick_nodes);
  printf("shift %.6E\ndissipation %.6E\npeak shear %.6E\n", loads.motion[MFV_SHIFT], loads.dissipation, peak);
  return EXIT_SUCCESS;
}

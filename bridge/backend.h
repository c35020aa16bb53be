/* Back-end of ligature-bridge for a device whose SDK is not part of this project (Force Dimension, 3D Systems, ..).
 *
 * Write a shared library that defines ligature_backend_open(), compile it where the SDK is, and start
 *   ligature-bridge --backend ./my_device.so ..
 * This file is all that it needs from this project. docs/bridge.md has an example.
 *
 * Frame D of all vectors: x to the right, y away from the person, z up; origin as in the device record. SI units. */
#ifndef LIGATURE_BRIDGE_BACKEND_H
#define LIGATURE_BRIDGE_BACKEND_H
#ifdef __cplusplus
extern "C" {
#endif

#define LIGATURE_BACKEND_VERSION 1

/* NOLINTBEGIN(readability-identifier-naming): names as C libraries have them */

enum {
  LIGATURE_BUTTON_GRIP = 1,     /* closes the jaws in the scene */
  LIGATURE_BUTTON_DEAD_MAN = 2, /* allows force while it is pressed */
  LIGATURE_BUTTON_CLUTCH = 4    /* the tool stays while the hand moves on */
};

struct ligature_backend_state {
  double position_m[3];
  unsigned buttons; /* LIGATURE_BUTTON_ bits */
};

struct ligature_backend {
  int version; /* LIGATURE_BACKEND_VERSION */
  void* device;

  /* Sends this force to the device and reads its state. Called some thousand times a second from one thread. It may
   * wait for the device, but at most 10 ms. @return 1 and the state; 0 when the device did not answer. After 0 the
   * bridge calls it again: a device that comes back is used again. */
  int (*exchange)(void* device, const double force_N[3], struct ligature_backend_state* state);

  /* Sets the force to zero and gives the device back. Not called when the bridge is killed: the library, or the
   * device itself, must end the force then. */
  void (*close)(void* device);
};

/* @param address   what follows --address on the command line; "" without it
 * @param backend   to be filled in
 * @param problem   to be filled with one line about what is wrong, when 0 is returned
 * @return 1 when the device is ready */
int ligature_backend_open(const char* address, struct ligature_backend* backend, char* problem, int problem_bytes);
/* NOLINTEND(readability-identifier-naming) */

#ifdef __cplusplus
}
#endif
#endif

// A C++ program of a user's: solves the case that its argument names and prints how many nodes are in contact.
#include <mfv.h>

#include <cstdint>
#include <iostream>
#include <memory>

int main(int count, char **arguments) {
  if (count < 2) return 2;
  mfv_case *handle = nullptr;
  char message[400] = "";
  if (mfv_create_from_file(arguments[1], &handle, message, sizeof message) != MFV_COMPLETE) {
    std::cerr << message << '\n';
    return 1;
  }
  const auto free_case = [](mfv_case *one) { mfv_free(&one); };
  const std::unique_ptr<mfv_case, decltype(free_case)> owner(handle, free_case);
  std::int32_t nodes = 0;
  if (mfv_run(handle) != MFV_COMPLETE) return 1;
  if (mfv_copy_integer(handle, "summary/contact_nodes", &nodes, 1) != MFV_COMPLETE) return 1;
  std::cout << "contact nodes " << nodes << '\n';
}

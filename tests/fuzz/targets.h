// targets: readers of the product, each over bytes that nobody made with care. A target demands of its reader: the
// bytes are read, or refused by an InputError with a sentence; what was read keeps the reader's promises. Anything else
// ends the program (demand.h), where the fuzzer sees it.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>

namespace pincer::fuzz {

using Bytes = std::span<const std::uint8_t>;

inline std::string_view textOf(Bytes input) { return {reinterpret_cast<const char*>(input.data()), input.size()}; }

// contact
void mesh_obj(Bytes input);
void mesh_stl(Bytes input);
void mesh_ply(Bytes input);
void mesh_off(Bytes input);
void mesh_repair(Bytes input);  // a mesh drawn by the bytes: inspected, repaired, inspected again

// devices
void usb_frame(Bytes input);      // 64 bytes, and what its payload says
void falcon_packet(Bytes input);  // USB packets: a byte of length before each
void haply_message(Bytes input);  // the texts of the service, each as every kind of answer

// tasks/run
void json(Bytes input);
void xml(Bytes input);
void mjcf(Bytes input);        // a robot's file, the scene of it and its world
void urdf(Bytes input);        // likewise
void scene(Bytes input);       // and the world of it
void scene_step(Bytes input);  // likewise, and some ticks
// scenes drawn from the schema by the bytes: the reader knows every key that the schema has
void scene_schema(Bytes input);
void trajectory(Bytes input);
void calibration(Bytes input);
void recording(Bytes input);   // a CSV file for --devices replay
void replay_log(Bytes input);  // packed inputs of a person's trial
void session(Bytes input);     // a session's file with these bytes changed

// tasks/lab
void study(Bytes input);  // as every kind of study
void sweep_cases(Bytes input);

}  // namespace pincer::fuzz

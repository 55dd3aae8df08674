// The table of a sweep for who reads HDF5: by h5py, MATLAB, Julia.
#include <fmt/format.h>
#include <hdf5.h>

#include "pincer/contact/error.h"
#include "pincer/contact/io/part_file.h"
#include "pincer/tasks/lab/sweep/sweep_parts.h"

namespace pincer::tasks {
namespace {

// An identifier of the library's, closed at the end; or InputError where it couldn't be made.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id_ < 0) throw InputError("the HDF5 file can't be written: the library refuses. Is the disk full?");
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void must(herr_t code) {
  if (code < 0) throw InputError("the HDF5 file can't be written. Is the disk full?");
}

// Without times, so that equal tables are equal bytes.
class Hdf5File {
 public:
  explicit Hdf5File(const std::string& path)
      : file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose),
        timeless_(H5Pcreate(H5P_DATASET_CREATE), H5Pclose),
        groups_(H5Pcreate(H5P_GROUP_CREATE), H5Pclose),
        text_(H5Tcopy(H5T_C_S1), H5Tclose) {
    must(H5Pset_obj_track_times(timeless_, false));
    must(H5Pset_obj_track_times(groups_, false));
    must(H5Pset_link_creation_order(groups_, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
    must(H5Tset_size(text_, H5T_VARIABLE));
    must(H5Tset_cset(text_, H5T_CSET_UTF8));
  }

  void addGroup(const std::string& name) {
    const Handle group(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, groups_, H5P_DEFAULT), H5Gclose);
  }
  void add(const std::string& name, const std::vector<double>& values) {
    add(name, H5T_NATIVE_DOUBLE, values.size(), values.data(), H5T_IEEE_F64LE);
  }
  void add(const std::string& name, const std::vector<std::string>& values) {
    std::vector<const char*> texts;
    for (const std::string& value : values) texts.push_back(value.c_str());
    add(name, text_, texts.size(), texts.data(), text_);
  }
  void note(const std::string& name, const std::string& value) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(file_, name.c_str(), text_, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    const char* text = value.c_str();
    must(H5Awrite(attribute, text_, &text));
  }

 private:
  void add(const std::string& name, hid_t type, std::size_t count, const void* data, hid_t stored) {
    const hsize_t size = count;
    const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
    const Handle set(H5Dcreate2(file_, name.c_str(), stored, space, H5P_DEFAULT, timeless_, H5P_DEFAULT), H5Dclose);
    if (count > 0) must(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data));
  }

  Handle file_, timeless_, groups_, text_;
};

// A "/" would make groups of a name.
std::string linkName(std::string name) {
  for (char& c : name) c = c == '/' ? '|' : c;
  return name;
}

void fill(Hdf5File& file, const SweepTable& table) {
  file.note("what", table.what);
  std::vector<double> cases;
  std::vector<std::string> hashes, errors;
  for (std::size_t i = 0; i < table.results.size(); ++i) {
    if (!table.results[i].done) continue;
    cases.push_back(static_cast<double>(i));
    hashes.push_back(table.results[i].state_hash);
    errors.push_back(table.results[i].error);
  }
  const auto column = [&](auto valueOf) {
    std::vector<double> values;
    for (const double i : cases) values.push_back(valueOf(static_cast<std::size_t>(i)));
    return values;
  };
  file.add("/case", cases);
  file.addGroup("/parameters");
  for (std::size_t p = 0; p < table.parameters.size(); ++p)
    file.add("/parameters/" + linkName(table.parameters[p]), column([&](std::size_t i) { return table.points[i][p]; }));
  file.addGroup("/measures");
  for (std::size_t m = 0; m < table.measures.size(); ++m)
    file.add("/measures/" + linkName(table.measures[m]),
             column([&](std::size_t i) { return table.results[i].values[m]; }));
  file.add("/state_hash", hashes);
  file.add("/error", errors);
}

}  // namespace

void writeSweepHdf5(const SweepTable& table, const std::string& path) {
  must(H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr));  // what goes wrong is said by us
  PartFile part(path);
  part.release();
  {
    Hdf5File file(part.name());
    fill(file, table);
  }
  placeWritten(part.name(), path);
}

}  // namespace pincer::tasks

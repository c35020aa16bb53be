#include "host/hdf5_file.hpp"

#include <utility>

#include "host/errors.hpp"

namespace ligature::host::hdf5 {
namespace {

void check(herr_t result, const char* doing) {
  if (result < 0) throw RunFailed(std::string("HDF5: cannot ") + doing + "; is the disk full?");
}

hid_t text_type() {
  static const hid_t type = [] {
    const hid_t t = H5Tcopy(H5T_C_S1);
    H5Tset_size(t, H5T_VARIABLE);
    H5Tset_cset(t, H5T_CSET_UTF8);
    return t;
  }();
  return type;
}

}  // namespace

Handle::Handle(hid_t id, Close close, const char* doing) {
  if (id < 0) throw RunFailed(std::string("HDF5: cannot ") + doing);
  id_ = std::shared_ptr<hid_t>(new hid_t(id), [close](const hid_t* p) {
    close(*p);
    delete p;
  });
}

Handle make_file(const std::string& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // turns off HDF5's own error output; RunFailed carries one line instead
  return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, "make the file"};
}

Handle make_group(hid_t parent, const char* name) {
  return {H5Gcreate2(parent, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "make a group"};
}

void annotate(hid_t object, const char* name, const std::string& text) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "make an attribute");
  const Handle attribute(H5Acreate2(object, name, text_type(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "make an attribute");
  const char* words = text.c_str();
  check(H5Awrite(attribute.id(), text_type(), static_cast<const void*>(&words)), "write an attribute");
}

void annotate(hid_t object, const char* name, double value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "make an attribute");
  const Handle attribute(H5Acreate2(object, name, H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "make an attribute");
  check(H5Awrite(attribute.id(), H5T_NATIVE_DOUBLE, &value), "write an attribute");
}

template <>
hid_t type_of<std::int64_t>() {
  return H5T_NATIVE_INT64;
}
template <>
hid_t type_of<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
hid_t type_of<float>() {
  return H5T_NATIVE_FLOAT;
}
template <>
hid_t type_of<std::string>() {
  return text_type();
}

template <class T>
Series<T>::Series(hid_t group, const char* name, hsize_t width) : width_(width) {
  const int rank = width > 1 ? 2 : 1;
  const hsize_t none[] = {0, width}, endless[] = {H5S_UNLIMITED, width}, chunk[] = {kGathered, width};
  const Handle space(H5Screate_simple(rank, none, endless), H5Sclose, "make a dataset");
  const Handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make a dataset");
  check(H5Pset_chunk(how.id(), rank, chunk), "make a dataset");
  check(H5Pset_shuffle(how.id()), "make a dataset");
  check(H5Pset_deflate(how.id(), 1), "make a dataset");
  dataset_ = {H5Dcreate2(group, name, type_of<T>(), space.id(), H5P_DEFAULT, how.id(), H5P_DEFAULT), H5Dclose,
              "make a dataset"};
}

template <class T>
void Series<T>::flush() {
  if (buffer_.empty()) return;
  const int rank = width_ > 1 ? 2 : 1;
  const hsize_t added[] = {buffer_.size() / width_, width_}, from[] = {rows_, 0};
  const hsize_t size[] = {rows_ + added[0], width_};
  check(H5Dset_extent(dataset_.id(), size), "grow a dataset");
  const Handle file(H5Dget_space(dataset_.id()), H5Sclose, "write");
  check(H5Sselect_hyperslab(file.id(), H5S_SELECT_SET, from, nullptr, added, nullptr), "write");
  const Handle memory(H5Screate_simple(rank, added, nullptr), H5Sclose, "write");
  const void* data = nullptr;
  std::vector<const char*> words;
  if constexpr (std::is_same_v<T, std::string>) {
    for (const auto& text : buffer_) words.push_back(text.c_str());
    data = static_cast<const void*>(words.data());
  } else {
    data = buffer_.data();
  }
  check(H5Dwrite(dataset_.id(), type_of<T>(), memory.id(), file.id(), H5P_DEFAULT, data), "write");
  rows_ = size[0];
  buffer_.clear();
}

template class Series<std::int64_t>;
template class Series<double>;
template class Series<float>;
template class Series<std::string>;

}  // namespace ligature::host::hdf5

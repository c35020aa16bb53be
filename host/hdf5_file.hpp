#pragma once
#include <hdf5.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace ligature::host::hdf5 {

/// An HDF5 identifier with shared ownership, closed with its last copy.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  /// @param doing what the HDF5 call tried to do, for the error message. @throws RunFailed when `id` is invalid.
  Handle(hid_t id, Close close, const char* doing);
  [[nodiscard]] hid_t id() const { return *id_; }

 private:
  std::shared_ptr<hid_t> id_;
};

[[nodiscard]] Handle make_file(const std::string& path);
[[nodiscard]] Handle make_group(hid_t parent, const char* name);

/// Adds an attribute: UTF-8 text or a number.
void annotate(hid_t object, const char* name, const std::string& text);
void annotate(hid_t object, const char* name, double value);

/// HDF5 type of a C++ number; std::string is UTF-8 text of any length.
template <class T>
[[nodiscard]] hid_t type_of();

/// A growing dataset of n values, or of n rows of `width` values. Chunked and compressed (deflate). Rows are buffered,
/// so that add() costs one copy.
template <class T>
class Series {
 public:
  Series(hid_t group, const char* name, hsize_t width = 1);
  void add(T value) {
    buffer_.push_back(std::move(value));
    if (buffer_.size() >= kGathered * width_) flush();
  }
  void flush();
  [[nodiscard]] hid_t id() const { return dataset_.id(); }

 private:
  static constexpr hsize_t kGathered = 4096;
  Handle dataset_;
  hsize_t width_, rows_ = 0;
  std::vector<T> buffer_;
};

extern template class Series<std::int64_t>;
extern template class Series<double>;
extern template class Series<float>;
extern template class Series<std::string>;

}  // namespace ligature::host::hdf5

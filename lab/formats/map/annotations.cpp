// Boxes that people drew in images: COCO's annotations, with a frame for each image, and LabelMe's shapes.
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/map/text.hpp"
#include "lab/formats/text.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab {
namespace {

/// The annotations of a COCO file. Boxes of different images are unrelated, so each frame's boxes are
/// numbered anew.
class ImageFrames final : public FrameReader<2, double> {
 public:
  ImageFrames(MapText& text, json::object root, MapIds& ids, Quarantine& quarantine, std::string name)
      : name_(std::move(name)) {
    labels_->has_ids = ids.any();
    std::unordered_map<std::string, std::size_t> numbers;
    for (auto result : text.array(text.field(root, "annotations"), "an array of annotations")) {
      text.begin_feature();
      json::object annotation = text.object(text.element(result), "an annotation");
      std::string image;
      if (const auto value = text.optional_field(annotation, "image_id"))
        image = text.label(*value, "an image's id");
      const std::size_t frame = numbers.try_emplace(image, numbers.size()).first->second;
      if (frame == images_.size()) images_.push_back({std::move(image), {}, {}});
      images_[frame].ids.push_back(ids.of_member(text, annotation));
      DoubleBox2 box = absent_box<2, double>();
      quarantine.holds([&] { box = box_of(text, annotation); });
      images_[frame].boxes.push_back(box);
    }
    text.end_features();
    left_out_ = quarantine.warning(name_);
  }

  std::vector<DoubleBox2> first() override { return images_.empty() ? std::vector<DoubleBox2>() : take(); }

  bool next(Step<2, double>& step) override {
    if (next_ >= images_.size()) return false;
    step = {};
    step.boxes = take();
    step.size = step.boxes.size();
    for (std::size_t i = 0; i < step.size; ++i) step.changed.push_back(BoxId(i));
    return true;
  }

  std::string warning() const override {
    std::string text;
    if (images_.size() > 1)
      text = fmt::format("{}: a frame for each of {} images, from --frame 0, image {}", name_,
                         grouped(images_.size()), shown(images_.front().name));
    return text + (text.empty() || left_out_.empty() ? "" : "\n") + left_out_;
  }

  std::shared_ptr<const BoxLabels> labels() const override { return labels_; }

  bool is_computed() const override { return true; }

 private:
  struct Image {
    std::string name;
    std::vector<DoubleBox2> boxes;
    std::vector<std::string> ids;
  };

  std::vector<DoubleBox2> take() {
    Image& image = images_[next_++];
    if (labels_->has_ids) labels_->ids = std::move(image.ids);
    return std::move(image.boxes);
  }

  /// "bbox": a corner and the size. The box is absent if an annotation has no bbox.
  static DoubleBox2 box_of(MapText& text, json::object& annotation) {
    const auto bbox = text.optional_field(annotation, "bbox");
    if (!bbox) return absent_box<2, double>();
    std::array<double, 4> numbers{};
    std::size_t count = 0;
    for (auto result : text.array(*bbox, "the array x, y, width, height")) {
      const double number = text.number(text.element(result));
      if (count < numbers.size()) numbers[count] = number;
      ++count;
    }
    if (count == 0) return absent_box<2, double>();
    if (count != numbers.size() || !(numbers[2] >= 0) || !(numbers[3] >= 0))
      text.refuse(
          fmt::format("a bbox of {} numbers, with width {} and height {}", count, numbers[2], numbers[3]),
          "x, y and a width and height of 0 or more");
    return {{numbers[0], numbers[1]}, {numbers[0] + numbers[2], numbers[1] + numbers[3]}};
  }

  std::string name_;
  std::vector<Image> images_;
  std::size_t next_ = 0;
  std::shared_ptr<BoxLabels> labels_ = std::make_shared<BoxLabels>();
  std::string left_out_;
};

}  // namespace

AnyFrameReader read_coco(MapText& text, json::object root, MapIds& ids, Quarantine& quarantine,
                         std::string name) {
  return std::make_unique<ImageFrames>(text, root, ids, quarantine, std::move(name));
}

void read_labelme(MapText& text, json::object root, MapIds& ids, Quarantine& quarantine, MapBoxes& boxes) {
  for (auto result : text.array(text.field(root, "shapes"), "an array of shapes")) {
    text.begin_feature();
    boxes.begin_feature();
    const auto read = [&] {
      json::object shape = text.object(text.element(result), "a shape");
      boxes.set_id(ids.of_member(text, shape));
      // Its two points are the centre and a point on the circle.
      if (const auto type = text.optional_field(shape, "shape_type");
          type && text.string(*type, "a shape's type") == "circle")
        text.refuse("a circle", "rectangles, polygons, lines or points");
      for (auto point : text.array(text.field(shape, "points"), "an array of points")) {
        std::array<double, 2> place{};
        std::size_t count = 0;
        for (auto number : text.array(text.element(point), "a point: two numbers")) {
          const double value = text.number(text.element(number));
          if (count < place.size()) place[count] = value;
          ++count;
        }
        if (count != place.size()) text.refuse(fmt::format("a point of {} numbers", count), "2");
        boxes.add(place[0], place[1], true);
      }
      boxes.end_piece();
      boxes.end_feature();
    };
    if (!quarantine.holds(read)) boxes.drop_feature();
  }
  text.end_features();
}

}  // namespace broadside::lab

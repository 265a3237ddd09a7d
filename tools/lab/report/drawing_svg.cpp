// A drawing as an SVG file.
#include <algorithm>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "lab/numbers.hpp"
#include "lab/report/drawing.hpp"

namespace broadside::lab {
namespace {

/// The width of a panel and of the space around it, in pixels.
constexpr int panel_width = 420;
constexpr int gap = 20;
constexpr int title_height = 46;
constexpr int key_line_height = 16;
constexpr std::size_t max_columns = 3;

/// How many characters of a caption fit into a panel's width.
constexpr std::size_t caption_length = 72;

constexpr const char* style =
    "text{font-family:system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue',Arial,sans-serif;"
    "fill:#1f2328}"
    ".t{font-size:15px;font-weight:600}.c{font-size:11.5px;fill:#57606a}"
    ".f{fill:#fff;stroke:#d0d7de}"
    ".b path{vector-effect:non-scaling-stroke;stroke-width:.8}"
    ".a{fill:#8c959f;fill-opacity:.2;stroke:#6e7781}"
    ".o{fill:#d4622a;fill-opacity:.2;stroke:#b9501c}"
    ".l path{vector-effect:non-scaling-stroke;fill:none;stroke:#1f6feb}"
    ".s{vector-effect:non-scaling-stroke;fill:#1a7f37;fill-opacity:.16;stroke:#1a7f37;stroke-width:1.6}";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        // XML does not allow control characters.
        out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return out;
}

struct Panel {
  const DrawingView* view;
  std::size_t number;         // of the view
  const DrawingLayer* layer;  // null if there is none
};

/// A text as SVG, cut to `max_length` characters; the whole text is its tooltip.
std::string shortened(const std::string& text, std::size_t max_length = caption_length) {
  if (text.size() <= max_length) return escaped(text);
  return escaped(text.substr(0, max_length - 3)) + "...<title>" + escaped(text) + "</title>";
}

std::string caption_of(const DrawingLayer& layer) {
  return layer.caption.empty() ? "nothing laid over the boxes" : layer.caption;
}

/// Upper levels of a layer have stronger lines.
std::string lines_of(const DrawingLayer& layer) {
  std::string lines;
  const std::size_t count = layer.levels.size();
  for (std::size_t level = count; level-- > 0;) {
    if (layer.levels[level].empty()) continue;
    const double share = count < 2 ? 0 : static_cast<double>(level) / static_cast<double>(count - 1);
    lines += fmt::format("<path d=\"{}\" stroke-width=\"{:.1f}\" stroke-opacity=\"{:.2f}\"/>\n",
                         layer.levels[level], 1.8 - 0.8 * share, 1 - 0.25 * share);
  }
  return lines;
}

std::string panel_at(const Drawing& drawing, const Panel& panel, int x, int y, int height) {
  const DrawingView& view = *panel.view;
  const double scale = static_cast<double>(panel_width) / view.width;
  std::string title = panel.layer == nullptr ? drawing.scene : panel.layer->algorithm;
  if (drawing.dimension == 3) title += fmt::format(", {} to the right, {} up", view.axes[0], view.axes[1]);
  const std::string caption = panel.layer == nullptr ? "" : caption_of(*panel.layer);
  std::string text = fmt::format("<g transform=\"translate({} {})\">\n<text class=\"t\" y=\"15\">{}</text>\n",
                                 x, y, shortened(title));
  text += fmt::format("<text class=\"c\" y=\"34\">{}</text>\n", shortened(caption));
  text += fmt::format("<svg y=\"{}\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\">\n", title_height,
                      panel_width, height, view.width, view.height);
  text += fmt::format("<rect class=\"f\" width=\"{}\" height=\"{}\" stroke-width=\"{:.1f}\"/>\n", view.width,
                      view.height, 2 / scale);
  text += fmt::format("<use href=\"#b{}\"/>\n", panel.number);
  if (panel.layer != nullptr) {
    text += "<g class=\"l\">\n" + lines_of(*panel.layer) + "</g>\n";
    if (!panel.layer->active.empty())
      text += fmt::format("<path class=\"s\" d=\"{}\"/>\n", panel.layer->active);
  }
  return text + "</svg>\n</g>\n";
}

/// "300 of 3,442 boxes, the 2 largest among them".
std::string drawn_boxes(const Drawing& drawing) {
  if (drawing.of <= drawing.boxes) return counted(drawing.boxes, "box", "boxes");
  std::string text = fmt::format("{} of {} boxes", grouped(drawing.boxes), grouped(drawing.of));
  if (drawing.largest == 1) text += ", the largest among them";
  if (drawing.largest > 1) text += fmt::format(", the {} largest among them", grouped(drawing.largest));
  return text;
}

/// The description of the picture for screen readers.
std::string description_of(const Drawing& drawing) {
  std::string text = fmt::format("{} in {}D", drawn_boxes(drawing), drawing.dimension);
  text += "; boxes that overlap another one are orange.";
  if (drawing.views.empty()) return text;
  for (const DrawingLayer& layer : drawing.views[0].layers) {
    text += fmt::format(" {}: {}.", layer.algorithm, caption_of(layer));
    if (!layer.active.empty())
      text += " Half way of a sweep, its line and the boxes that it crosses are green.";
  }
  return text;
}

}  // namespace

std::string svg_of(const Drawing& drawing) {
  std::vector<Panel> panels;
  std::size_t layers = 0;
  for (const DrawingView& view : drawing.views) layers = std::max(layers, view.layers.size());
  for (std::size_t layer = 0; layer < std::max<std::size_t>(layers, 1); ++layer) {
    for (std::size_t i = 0; i < drawing.views.size(); ++i) {
      const DrawingView& view = drawing.views[i];
      panels.push_back({&view, i, layers == 0 ? nullptr : &view.layers[layer]});
    }
  }
  const auto height_of = [](const Panel& panel) {
    return panel_width * panel.view->height / panel.view->width;
  };
  const std::size_t columns = std::clamp<std::size_t>(panels.size(), 1, max_columns);
  std::string body;
  int y = gap;
  for (std::size_t first = 0; first < panels.size(); first += columns) {
    int highest = 0;
    for (std::size_t i = first; i < std::min(first + columns, panels.size()); ++i) {
      const int x = gap + static_cast<int>(i - first) * (panel_width + gap);
      body += panel_at(drawing, panels[i], x, y, height_of(panels[i]));
      highest = std::max(highest, height_of(panels[i]));
    }
    y += title_height + highest + gap;
  }
  const int width = gap + static_cast<int>(columns) * (panel_width + gap);
  std::string key = fmt::format("{}, {}.", drawing.scene, drawn_boxes(drawing));
  if (drawing.of > drawing.boxes && layers > 0)
    key += fmt::format(" What lies over them is that of these {}.", grouped(drawing.boxes));
  std::string colours = "Orange: overlaps another.";
  const bool swept = std::ranges::any_of(
      panels, [](const Panel& panel) { return panel.layer != nullptr && !panel.layer->active.empty(); });
  if (swept) colours += " Green: a sweep half way.";
  // On one line if the picture is wide enough.
  std::vector<std::string> key_lines = {key + " " + colours};
  if (key_lines[0].size() > columns * caption_length) key_lines = {key, colours};
  const int height = y + gap / 2 + key_line_height * static_cast<int>(key_lines.size());

  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "role=\"img\" aria-labelledby=\"title description\">\n",
      width, height);
  text +=
      fmt::format("<title id=\"title\">Boxes of the scene {}</title>\n<desc id=\"description\">{}</desc>\n",
                  escaped(drawing.scene), escaped(description_of(drawing)));
  text += fmt::format("<style>{}</style>\n<defs>\n", style);
  for (std::size_t i = 0; i < drawing.views.size(); ++i) {
    const DrawingView& view = drawing.views[i];
    text += fmt::format(
        "<g id=\"b{}\" class=\"b\">\n<path class=\"a\" d=\"{}\"/>\n<path class=\"o\" d=\"{}\"/>\n</g>\n", i,
        view.alone, view.touching);
  }
  text += fmt::format("</defs>\n<rect width=\"{}\" height=\"{}\" fill=\"#f6f8fa\"/>\n", width, height);
  text += body;
  for (const std::string& line : key_lines) {
    text += fmt::format("<text class=\"c\" x=\"{}\" y=\"{}\">{}</text>\n", gap, y + gap / 2,
                        shortened(line, columns * caption_length));
    y += key_line_height;
  }
  return text + "</svg>\n";
}

}  // namespace broadside::lab

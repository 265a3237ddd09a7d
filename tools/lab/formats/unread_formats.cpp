// The only table of formats that are recognised but not supported, and of their converters.
#include "lab/formats/unread_formats.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

#include "lab/formats/text.hpp"

namespace broadside::lab {
namespace {

using std::string_view_literals::operator""sv;

struct UnreadFormat {
  std::string_view name;
  std::string_view extensions;  ///< with a blank after each
  std::string_view magic;    ///< the first bytes, or the root element of XML ("<..."); empty: recognised by
                             ///< the name
  std::string_view command;  ///< the first IN stands for the file
};

// With as many digits as a double has, because ogr2ogr rounds coordinates by default.
constexpr std::string_view ogr = "ogr2ogr -f GeoJSON -lco SIGNIFICANT_FIGURES=17 out.geojson IN";
constexpr std::string_view pdal = "pdal translate IN out.ply (then --boxes vertices)";
constexpr std::string_view office = "libreoffice --headless --convert-to csv IN";

constexpr auto unread_formats = std::to_array<UnreadFormat>({
    {"a shapefile", ".shp ", "\x00\x00\x27\x0a"sv, ogr},
    {"a part of a shapefile", ".shx .dbf ", "", ogr},
    {"a GeoPackage or another database of SQLite", ".gpkg .sqlite ", "SQLite format 3\0"sv, ogr},
    {"FlatGeobuf", ".fgb ", "fgb\x03", ogr},
    {"KML", ".kml .kmz ", "<kml", ogr},
    {"GML", ".gml ", "<gml:", ogr},
    {"GPX", ".gpx ", "<gpx", "ogr2ogr -f GeoJSON -lco SIGNIFICANT_FIGURES=17 out.geojson IN tracks"},
    {"TopoJSON", ".topojson ", "", "npx -p topojson-client topo2geo LAYER=out.geojson < IN"},
    {"OpenStreetMap data", ".osm .pbf ", "<osm", "osmium export IN -o out.geojson"},
    {"MapInfo data", ".tab .mif ", "", ogr},
    {"a recording of Broadmark", ".aabbs ", "",
     "python3 -c \"import struct; d = open('IN', 'rb').read(); n, _ = struct.unpack_from('<2i', d, 256); "
     "print('frame,box,min_x,min_y,min_z,max_x,max_y,max_z'); [print(i // n, i % n, *b[:3], *b[4:7], "
     "sep=',') "
     "for i, b in enumerate(struct.iter_unpack('<8f', d[304:]))]\" > out.csv"},
    {"Parquet", ".parquet .geoparquet ", "PAR1\x15",
     "python3 -c \"import pandas; pandas.read_parquet('IN').to_csv('out.csv', index=False)\""},
    {"Arrow or Feather", ".arrow .feather ", "ARROW1\0"sv,
     "python3 -c \"import pandas; pandas.read_feather('IN').to_csv('out.csv', index=False)\""},
    {"a point cloud (LAS or LAZ)", ".las .laz ", "LASF", pdal},
    {"a point cloud (PCD)", ".pcd ", "# .PCD", pdal},
    {"HDF5", ".h5 .hdf5 ", "\x89HDF\r\n\x1a\n",
     "python3 -c \"import h5py, numpy; numpy.save('out.npy', h5py.File('IN')['NAME'][:])\""},
    {"a MATLAB file", ".mat ", "MATLAB 5.0 MAT-file",
     "python3 -c \"import scipy.io, numpy; numpy.save('out.npy', scipy.io.loadmat('IN')['NAME'])\""},
    {"an annotation in Pascal VOC's XML", "", "<annotation",
     "python3 -c \"import xml.etree.ElementTree as E; print('xmin,ymin,xmax,ymax'); [print(*(b.findtext(k) "
     "for k in "
     "('xmin', 'ymin', 'xmax', 'ymax')), sep=',') for b in E.parse('IN').iter('bndbox')]\" > out.csv"},
    {"intervals of a genome (BED)", ".bed ", "",
     "awk -v OFS=, 'NR == 1 {print \"chrom,start,end\"} {print $1, $2, $3}' IN > out.csv"},
    {"a pickle of Python", ".pkl .pickle ", "",
     "python3 -c \"import pickle, numpy; numpy.save('out.npy', pickle.load(open('IN', 'rb')))\""},
    {"a spreadsheet", ".xls ", "\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", office},
    {"a spreadsheet", ".xlsx .ods ", "", office},
    {"a mesh of VTK", ".vtk .vtu .vtp ", "# vtk DataFile", "meshio convert IN out.ply"},
    {"a mesh of Gmsh", ".msh ", "$MeshFormat", "meshio convert IN out.ply"},
    {"compressed by bzip2", ".bz2 ", "BZh", "bunzip2 -k IN"},
    {"compressed by xz", ".xz ", "\xFD\x37zXZ\x00"sv, "unxz -k IN"},
    {"compressed by LZ4", ".lz4 ", "\x04\x22\x4D\x18", "lz4 -d IN"},
    {"a zip archive", ".zip ", "", "unzip IN"},
});

bool begins_with(std::string_view beginning, std::string_view magic) {
  if (magic.empty()) return false;
  if (!magic.starts_with('<')) return beginning.starts_with(magic);
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (beginning.starts_with(byte_order_mark)) beginning.remove_prefix(byte_order_mark.size());
  return beginning.starts_with('<') && beginning.find(magic) != std::string_view::npos;
}

bool has_extension(const UnreadFormat& format, std::string_view extension) {
  return !extension.empty() && format.extensions.find(std::string(extension) + ' ') != std::string_view::npos;
}

std::string command_for(const UnreadFormat& format, std::string_view file) {
  std::string command(format.command);
  const std::size_t at = command.find("IN");
  return command.replace(at, 2, plainly(file));
}

}  // namespace

std::string unread_format(std::string_view beginning, std::string_view extension, std::string_view file) {
  const auto found =
      std::find_if(unread_formats.begin(), unread_formats.end(), [&](const UnreadFormat& format) {
        return extension.empty() ? begins_with(beginning, format.magic) : has_extension(format, extension);
      });
  if (found == unread_formats.end()) return {};
  return fmt::format("is {}, which is not read here; expected what a converter makes of it: {}", found->name,
                     command_for(*found, file));
}

}  // namespace broadside::lab

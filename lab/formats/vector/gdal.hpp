// GDAL's functions, loaded when a file first asks for them: GDAL brings a hundred libraries, with which every
// start of every program would take longer.
#pragma once

#include <cpl_error.h>
#include <gdal.h>
#include <ogr_api.h>

namespace broadside::lab::readers {

/// What the reader calls.
// clang-format off
#define BROADSIDE_GDAL_FUNCTIONS(function) \
  function(CPLErrorReset) function(CPLGetLastErrorMsg) function(CPLGetLastErrorType) \
  function(CPLPopErrorHandler) function(CPLPushErrorHandler) function(CPLQuietErrorHandler) \
  function(GDALAllRegister) function(GDALClose) function(GDALDatasetGetLayer) \
  function(GDALDatasetGetLayerCount) function(GDALOpenEx) function(OGR_FD_GetFieldCount) \
  function(OGR_FD_GetFieldDefn) function(OGR_FD_GetFieldIndex) function(OGR_FD_GetGeomFieldCount) \
  function(OGR_F_Destroy) function(OGR_F_GetFID) function(OGR_F_GetFieldAsString) \
  function(OGR_F_GetGeometryRef) function(OGR_F_IsFieldSetAndNotNull) function(OGR_Fld_GetNameRef) \
  function(OGR_G_GetEnvelope) function(OGR_G_GetGeometryCount) function(OGR_G_GetGeometryRef) \
  function(OGR_G_GetPointCount) function(OGR_G_GetX) function(OGR_G_GetY) function(OGR_G_IsEmpty) \
  function(OGR_L_GetFeatureCount) function(OGR_L_GetLayerDefn) function(OGR_L_GetName) \
  function(OGR_L_GetNextFeature) function(OGR_L_ResetReading)
// clang-format on

/// Pointers to them, under their own names.
struct Gdal {
// NOLINTNEXTLINE(bugprone-macro-parentheses): what is declared can stand in none.
#define BROADSIDE_GDAL_MEMBER(name) decltype(&::name) name = nullptr;
  // NOLINTNEXTLINE(readability-identifier-naming)
  BROADSIDE_GDAL_FUNCTIONS(BROADSIDE_GDAL_MEMBER)
#undef BROADSIDE_GDAL_MEMBER
};

/// GDAL, which stays loaded. Throws std::runtime_error, naming the library, if it cannot be.
const Gdal& gdal();

}  // namespace broadside::lab::readers

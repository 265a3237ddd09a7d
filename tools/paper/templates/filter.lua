-- What formats lack: a line with the caption below a figure of a page, and files behind links of what is printed.
function Link(element)
  if FORMAT == "gfm" or element.target:match("^#") or element.target:match("^%a+:") then return nil end
  local path = element.target:gsub("#.*$", "")
  if pandoc.utils.stringify(element.content) ~= path:match("[^/]*$") then return element.content end
  return pandoc.Code((("docs/paper/" .. path):gsub("[^/]+/%.%./", ""):gsub("[^/]+/%.%./", "")))
end

-- A table of few rows is not cut in two: LaTeX's long tables may be, and run over the foot of pages that have figures.
function Table(element)
  local rows = 0
  for _, body in ipairs(element.bodies) do rows = rows + #body.body end
  if FORMAT ~= "latex" or rows > 14 then return nil end
  local text = pandoc.write(pandoc.Pandoc({element}), "latex"):gsub("\\endhead\n", "")
    :gsub("\\begin{longtable}%[%]", "\\begin{center}\\footnotesize\\begin{tabular}")
    :gsub("\\end{longtable}", "\\end{tabular}\\end{center}")
  return pandoc.RawBlock("latex", text)
end

-- Between the functions of a listing a page may end, or a long one would leave half a page empty before it.
function CodeBlock(element)
  if FORMAT ~= "latex" then return nil end
  local functions = {}
  for text in (element.text .. "\n\n"):gmatch("(.-)\n\n") do table.insert(functions, pandoc.CodeBlock(text, element.attr)) end
  return functions
end

-- The sources, without the boxes that HTML has around them.
function Div(element)
  if FORMAT == "gfm" then return element.content end
end

function Para(element)
  local image = element.content[1]
  if FORMAT ~= "gfm" or #element.content ~= 1 or image.t ~= "Image" then return nil end
  return {pandoc.Para({pandoc.Image({pandoc.Str("")}, image.src)}), pandoc.Para({pandoc.Emph(image.caption)})}
end

-- Prepares the paper's Markdown for LaTeX and HTML: figures with their captions, two beside each other where they are
-- narrow; listings under their titles on one page; columns as wide as what stands in them.
local narrow = 500  -- an SVG up to this wide, in its pixels, takes half a line
local latex = FORMAT == "latex"

-- <a id="name"></a>, to which links lead.
local function anchor(element)
  local id = element.format == "html" and element.text:match('^<a id="([%w_]+)">$')
  if id then return pandoc.Span({}, {id = id}) end
  if element.format == "html" then return {} end
end

-- Other pages of the repository are not beside what is printed: where a name is a file's, its path there stands.
local function link(element)
  local target = element.target
  if target:match("^#") or target:match("^%a+:") then return nil end
  local path = target:gsub("#.*$", "")
  if pandoc.utils.stringify(element.content) ~= path:match("[^/]*$") then return element.content end
  if path:match("^%.%./%.%./") then path = path:sub(7)
  elseif path:match("^%.%./") then path = "docs/" .. path:sub(4)
  else path = "docs/paper/" .. path end
  return pandoc.Str(path)
end

local function size_of(path)
  local file = assert(io.open(path))
  local head = file:read(400)
  file:close()
  local width, height = head:match('<svg[^>]- width="([%d.]+)"'), head:match('<svg[^>]- height="([%d.]+)"')
  return tonumber(width), tonumber(height)
end

-- An image that is a paragraph of its own, and the paragraph behind it: *Figure 3. What it shows*.
local function figure_at(blocks, i)
  local image, caption = blocks[i], blocks[i + 1]
  if not image or image.t ~= "Para" or #image.content ~= 1 or image.content[1].t ~= "Image" then return nil end
  if not caption or caption.t ~= "Para" or caption.content[1].t ~= "Emph" then
    error("an image without a caption behind it: " .. image.content[1].src)
  end
  local source = image.content[1].src
  local width, height = size_of(source)
  return {source = source, width = width, height = height, caption = caption.content[1].content}
end

local function tex(inlines)
  return (pandoc.write(pandoc.Pandoc({pandoc.Plain(inlines)}), "latex"):gsub("%s+$", ""))
end

-- Where scripts/print_paper puts the PDF of an SVG.
local function printed(source)
  return (source:gsub("^%.%./", ""):gsub("%.svg$", ".pdf"))
end

local function tex_figure(figure, width)
  return string.format("\\begin{minipage}[t]{%s}\\centering\\vspace{0pt}\\includegraphics[width=\\linewidth]{%s}\\par" ..
    "\\vspace{2pt}{\\footnotesize\\itshape %s\\par}\\end{minipage}", width, printed(figure.source), tex(figure.caption))
end

-- Figures that follow each other: narrow ones in pairs, others on a line of their own, each line a float.
local function tex_figures(figures)
  local floats, i = {}, 1
  while i <= #figures do
    local one, other = figures[i], figures[i + 1]
    local line
    if other and one.width <= narrow and other.width <= narrow then
      line = tex_figure(one, "0.485\\linewidth") .. "\\hfill" .. tex_figure(other, "0.485\\linewidth")
      i = i + 2
    else
      line = tex_figure(one, one.width <= narrow and "0.485\\linewidth" or "0.66\\linewidth")
      i = i + 1
    end
    table.insert(floats, pandoc.RawBlock("latex", "\\begin{figure}[!htbp]\\centering " .. line .. "\\end{figure}"))
  end
  return floats
end

local function html_figures(figures)
  local all = {}
  for _, figure in ipairs(figures) do
    local image = pandoc.Image(figure.caption, figure.source, "", {class = figure.width <= narrow and "narrow" or "wide"})
    local caption = pandoc.write(pandoc.Pandoc({pandoc.Plain(figure.caption)}), "html")
    table.insert(all, pandoc.RawBlock("html", "<figure>"))
    table.insert(all, pandoc.Plain({image}))
    table.insert(all, pandoc.RawBlock("html", "<figcaption>" .. caption .. "</figcaption></figure>"))
  end
  return all
end

-- A listing is never cut in two, nor from its title.
local function tex_listing(title, code)
  local head = title and ("\\textbf{\\small " .. tex(title.content[1].content) .. "}\\par") or ""
  return pandoc.RawBlock("latex", "\\medskip\\noindent\\begin{minipage}{\\linewidth}" .. head ..
    "\\begin{Verbatim}[fontsize=\\listingsize]\n" .. code.text .. "\n\\end{Verbatim}\n\\end{minipage}\\medskip")
end

-- The sources stand close together, in small print.
local function tex_sources(list)
  for _, item in ipairs(list.content) do
    for i, block in ipairs(item) do
      if block.t == "Para" then item[i] = pandoc.Plain(block.content) end
    end
  end
  return {pandoc.RawBlock("latex", "\\begingroup\\footnotesize"), list, pandoc.RawBlock("latex", "\\endgroup")}
end

-- A table that is not cut in two, with the title before it: text goes on where it does not fit.
local function captioned_table(title, block)
  local caption = title and title.t == "Para" and #title.content == 1 and title.content[1].t == "Emph"
  local table_there = block and block.t == "RawBlock" and block.text:match("^\\begin{center}")
  if not caption or not table_there then return nil end
  return pandoc.RawBlock("latex", "\\begin{table}[!htbp]\\centering{\\footnotesize\\itshape " ..
    tex(title.content[1].content) .. "\\par}" .. block.text .. "\\end{table}")
end

local function is_sources(block)
  return block and block.t == "Header" and pandoc.utils.stringify(block) == "References"
end

local function is_title(block)
  return block and block.t == "Para" and #block.content == 1 and block.content[1].t == "Strong"
end

local function blocks_of(blocks)
  local done, i = pandoc.List(), 1
  while i <= #blocks do
    local figures = {}
    local figure = figure_at(blocks, i)
    while figure do
      table.insert(figures, figure)
      i = i + 2
      figure = figure_at(blocks, i)
    end
    if #figures > 0 then
      done:extend(latex and tex_figures(figures) or html_figures(figures))
    elseif latex and captioned_table(blocks[i], blocks[i + 1]) then
      done:insert(captioned_table(blocks[i], blocks[i + 1]))
      i = i + 2
    elseif latex and is_title(blocks[i]) and blocks[i + 1] and blocks[i + 1].t == "CodeBlock" then
      done:insert(tex_listing(blocks[i], blocks[i + 1]))
      i = i + 2
    elseif latex and is_sources(blocks[i - 1]) and blocks[i].t == "OrderedList" then
      done:extend(tex_sources(blocks[i]))
      i = i + 1
    elseif latex and blocks[i].t == "CodeBlock" then
      done:insert(tex_listing(nil, blocks[i]))
      i = i + 1
    else
      done:insert(blocks[i])
      i = i + 1
    end
  end
  return done
end

-- Columns by what stands in them: what is short keeps its width, the rest share what is left.
local function fit(element)
  local most, sums = {}, {}
  for column = 1, #element.colspecs do most[column], sums[column] = 1, 1 end
  local function look(rows, words)
    for _, row in ipairs(rows) do
      for column, cell in ipairs(row.cells) do
        local length = 0
        for word in pandoc.utils.stringify(cell.contents):gmatch(words) do length = math.max(length, utf8.len(word)) end
        most[column] = math.max(most[column], length)
        sums[column] = sums[column] + length
      end
    end
  end
  look(element.head.rows, "%S+")  -- a heading may take several lines
  for _, body in ipairs(element.bodies) do look(body.body, ".+") end
  local whole = 0
  for _, length in ipairs(most) do whole = whole + length end
  local line = 128  -- characters, of which the gaps between columns take some
  local heads = 0
  for _, row in ipairs(element.head.rows) do
    for _, cell in ipairs(row.cells) do heads = heads + utf8.len(pandoc.utils.stringify(cell.contents)) end
  end
  if math.max(whole, heads) + 3 * #most <= line then return end
  local short, left, shares = 30, line, 0
  for column, length in ipairs(most) do
    if length <= short then left = left - length - 2 else shares = shares + math.sqrt(sums[column]) end
  end
  -- Where all are short, what is left is spread.
  local stretch = shares == 0 and line / (line - left) or 1
  for column, length in ipairs(most) do
    local width = length <= short and (length + 2) * stretch or left * math.sqrt(sums[column]) / shares
    element.colspecs[column] = {element.colspecs[column][1], width / line}
  end
end

-- A table of a few short rows is never cut in two; pandoc's own may be, and runs into the foot of a page that has figures.
local function table_of(element)
  fit(element)
  local rows, characters = 0, #pandoc.utils.stringify(element)
  for _, body in ipairs(element.bodies) do rows = rows + #body.body end
  if rows > 14 or characters > 1500 then return element end
  local text = pandoc.write(pandoc.Pandoc({element}), "latex")
    :gsub("\\begin{longtable}%[%]", "\\begin{center}\\footnotesize\\begin{tabular}")
    :gsub("\\end{longtable}", "\\end{tabular}\\end{center}"):gsub("\\endhead\n", "")
  return pandoc.RawBlock("latex", text)
end

return {
  {RawInline = anchor, RawBlock = function(element) if element.format == "html" then return {} end end},
  {Link = link, Table = latex and table_of or nil},
  {Pandoc = function(document) return pandoc.Pandoc(blocks_of(document.blocks), document.meta) end},
}

-- neovim.lua: a scene is edited by Neovim, whose own client asks `krs lsp`.
--
-- It says "all is well", or what is not.
local client = vim.lsp.start_client({ name = 'krs', cmd = { vim.env.KRS, 'lsp' }, root_dir = vim.fn.getcwd() })
vim.lsp.buf_attach_client(0, client)

local function told(count)
    return vim.wait(10000, function() return #vim.diagnostic.get(0) == count end, 50)
end

local function ask(method, line, column, more)
    local about = { textDocument = { uri = vim.uri_from_bufnr(0) }, position = { line = line, character = column } }
    local answers = vim.lsp.buf_request_sync(0, 'textDocument/' .. method, vim.tbl_extend('force', about, more or {}), 10000)
    return answers and answers[client] and answers[client].result
end

local function text()
    return table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, false), '\n')
end

local function session()
    assert(told(1), 'a mistake of reading')
    assert(vim.diagnostic.get(0)[1].lnum == 3, 'its line')
    assert(ask('hover', 2, 13).contents.value:find('= 2'), 'hover')
    local offered = vim.tbl_map(function(item) return item.label end, ask('completion', 3, 17))
    assert(vim.tbl_contains(offered, 'move'), 'completion')
    assert(ask('definition', 2, 6).uri:find('solids.krs'), 'definition')
    -- What Neovim sends are the parts that changed.
    vim.api.nvim_buf_set_lines(0, 1, 4, false, { 'let size = 3; // \u{1F30D}', 'show sphere(size);' })
    assert(told(0), 'no mistake is left')
    vim.lsp.util.apply_workspace_edit(ask('rename', 1, 5, { newName = 'width' }), 'utf-16')
    assert(text() == '/// How large.\nlet width = 3; // \u{1F30D}\nshow sphere(width);', text())
    vim.api.nvim_buf_set_text(0, 1, 12, 1, 13, { '4 * 2' })
    assert(ask('hover', 2, 14).contents.value:find('= 8'), 'hover behind changes')
end

local good, why = pcall(session)
vim.lsp.stop_client(client)
print(good and 'all is well' or why)

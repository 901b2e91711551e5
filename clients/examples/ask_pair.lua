--[[
Asks the service on the bus, from Lua, whether a cube and a tetrahedron that comes at it meet, when
and in which box; then the same for the next stretch of time, with keys in place of the components
that the service holds by then.

By hand, on Debian, with the message types that 'make install' puts into share/fmb/lcmtypes (in the
sources they are in msgs/):

    apt install liblcm-bin liblcm-lua lua5.2
    lcm-gen -l --lpath types /usr/local/share/fmb/lcmtypes/*.lcm
    fmbd &
    LUA_PATH='types/?.lua;;' lua5.2 ask_pair.lua

prints

    overlapping from 0.666667 to 1 s, box (0.5 0 0) to (1 1 1)
    overlapping from 0 to 1 s, box (0 0 0) to (1 1 1)

Arguments, which may be left out: the seconds of a stretch (1), and how often to ask before giving
up (6). The bus is that of LCM_DEFAULT_URL, or the usual one of this host. Exit codes: 0 answered,
1 refused or nobody answered, 2 wrong arguments.
--]]

-- What lcm-gen writes is for Lua 5.1, and takes this name when it is loaded.
unpack = unpack or table.unpack

local lcm = require 'lcm'
local frame_t = require 'fmb_msgs.frame_t'
local pair_query_t = require 'fmb_msgs.pair_query_t'
local pair_result_t = require 'fmb_msgs.pair_result_t'

local DEFAULT_URL = 'udpm://239.255.76.67:7667?ttl=0'
local QUERY_CHANNEL, RESULT_CHANNEL = 'FMB_PAIR_QUERY', 'FMB_PAIR_RESULT'
local TIMEOUT_MS = 500
local VERDICTS = {
    [pair_result_t.VERDICT_SEPARATED] = 'separated',
    [pair_result_t.VERDICT_TOUCHING] = 'touching',
    [pair_result_t.VERDICT_OVERLAPPING] = 'overlapping',
}

local function fail(code, ...)
    io.stderr:write('ask_pair.lua: ', string.format(...), '\n')
    os.exit(code, true)
end

---- A client of the service -----------------------------------------------------------------------

local Client = {}
Client.__index = Client

-- 53 random bits: all that a number of Lua 5.2 has room for, and all that the service takes.
local function random_id()
    local file = assert(io.open('/dev/urandom', 'rb'))
    local bytes = {file:read(7):byte(1, 7)}
    file:close()
    local id = bytes[1] % 32
    for i = 2, 7 do
        id = id * 256 + bytes[i]
    end
    return id
end

-- tries: how often a query is sent before it is given up, at least once.
function Client.open(url, tries)
    local opened, bus = pcall(lcm.lcm.new, url)
    if not opened then
        fail(1, 'cannot open the bus %s', url) -- liblcm has said why
    end
    local self = setmetatable({bus = bus, id = random_id(), number = 0, tries = tries}, Client)
    bus:subscribe(RESULT_CHANNEL, function(_, bytes) self:take(bytes) end)
    return self
end

-- Results go to everybody on the bus. Those of others are passed over, and so are second answers
-- to earlier queries, and what cannot be read: no error may leave this for liblcm's own code.
function Client:take(bytes)
    local readable, result = pcall(pair_result_t.decode, bytes)
    if readable and result.client_id == self.id and result.sequence_number == self.number then
        self.result = result
    end
end

function Client:answered()
    return self.result and self.result.status ~= pair_result_t.STATUS_BUSY
end

-- Until there is an answer, or the bus was silent for the time-out. Others may keep it from being
-- silent, and Lua's clock has whole seconds: then for one to two of them. (In Lua, LCM keeps 31
-- messages, and drops what comes meanwhile: where others ask fast, an answer may take some tries.)
function Client:listen()
    local start = os.time()
    while not self:answered() and self.bus:handle_timeout(TIMEOUT_MS) do
        local seconds = os.time() - start
        if seconds < 0 or seconds > 1 then
            break
        end
    end
end

-- LCM loses datagrams without a word, and a busy service wants to be asked again later: so the
-- same query goes out again after each time-out, with the same number. On output: the result, or
-- nil where there was none.
function Client:ask(query)
    self.number = self.number + 1
    self.result = nil
    query.utime = os.time() * 1e6
    query.client_id = self.id
    query.sequence_number = self.number
    local bytes = query:encode()
    for _ = 1, self.tries do
        self.bus:publish(QUERY_CHANNEL, bytes)
        self:listen()
        if self:answered() then
            break
        end
    end
    return self.result
end

-- A body is a table with id, shape, components, origin, velocity, and the key that the service
-- gave for it, if it did: it stands for the components.
local function frame_of(body)
    local frame = frame_t:new()
    frame.body_id = body.id
    frame.shape = body.shape
    frame.dim = #body.origin
    frame.origin = body.origin
    frame.velocity = body.velocity
    frame.num_velocity = #body.velocity
    if body.key then
        frame.key = body.key
    else
        frame.components = body.components
        frame.num_components = #body.components
    end
    return frame
end

function Client:ask_once(a, b, duration)
    local query = pair_query_t:new()
    query.duration = duration
    query.want = pair_query_t.WANT_BOX
    query.a, query.b = frame_of(a), frame_of(b)
    return self:ask(query)
end

-- Do two bodies meet within the duration? A key dies with the service, or when the service needs
-- the room, or gets other components under the same id from any client: then the bodies are sent
-- whole again. On output: the result, or nil where there was none.
function Client:ask_pair(a, b, duration)
    local result = self:ask_once(a, b, duration)
    if result and result.status == pair_result_t.STATUS_UNKNOWN_BODY then
        a.key, b.key = nil, nil
        result = self:ask_once(a, b, duration)
    end
    if result and result.status == pair_result_t.STATUS_OK then
        a.key, b.key = result.key_a, result.key_b
    end
    return result
end

---- A scene, and its answers ----------------------------------------------------------------------

local function numbers_text(numbers, first, last)
    local text = {}
    for i = first, last do
        text[#text + 1] = string.format('%g', numbers[i])
    end
    return table.concat(text, ' ')
end

local function result_text(result)
    local text = VERDICTS[result.verdict] or 'verdict ' .. result.verdict
    if result.num_contact == 2 then
        text = text .. string.format(' from %g to %g s', result.contact[1], result.contact[2])
    end
    if result.num_box > 0 then
        local dim = result.num_box / 2
        text = text .. string.format(', box (%s) to (%s)', numbers_text(result.box, 1, dim),
            numbers_text(result.box, dim + 1, 2 * dim))
    end
    return text
end

local function main()
    local duration, tries = tonumber(arg[1] or 1), tonumber(arg[2] or 6)
    if not duration or not tries or tries < 1 or arg[3] then
        fail(2, 'usage: ask_pair.lua [SECONDS [TRIES]]')
    end
    local url = os.getenv('LCM_DEFAULT_URL') or ''
    if url == '' then
        url = DEFAULT_URL
    end
    local client = Client.open(url, tries)
    local edges = {1, 0, 0, 0, 1, 0, 0, 0, 1}
    local cube = {id = 1, shape = frame_t.SHAPE_CUBOID, components = edges, origin = {0, 0, 0},
        velocity = {}}
    local tetrahedron = {id = 2, shape = frame_t.SHAPE_TETRAHEDRON, components = edges,
        origin = {2, 0, 0}, velocity = {-1.5, 0, 0}}
    for _ = 1, 2 do
        local result = client:ask_pair(cube, tetrahedron, duration)
        if not result then
            fail(1, "no fmbd answered on channel %s of %s: start one with 'fmbd &'",
                RESULT_CHANNEL, url)
        end
        if result.status ~= pair_result_t.STATUS_OK then
            fail(1, 'refused with status %d: %s', result.status, result.detail)
        end
        print(result_text(result))
        for axis, speed in ipairs(tetrahedron.velocity) do
            tetrahedron.origin[axis] = tetrahedron.origin[axis] + duration * speed
        end
    end
end

main()

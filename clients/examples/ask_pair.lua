--[[
Queries the service on the bus, from Lua: do a cube and a tetrahedron that moves towards it meet,
when and in which box? Then the same for the next stretch of time, with handles in place of the
frames that the service holds by then.

By hand, on Debian, with the message types that 'make install' puts into share/fmb/lcmtypes (in the
sources they are in msgs/):

    apt install liblcm-bin liblcm-lua lua5.2
    lcm-gen -l --lpath types /usr/local/share/fmb/lcmtypes/*.lcm
    fmbd &
    LUA_PATH='types/?.lua;;' lua5.2 ask_pair.lua

prints

    overlapping from 0.666667 to 1 s, box (0.5 0 0) to (1 1 1)
    overlapping from 0 to 1 s, box (0 0 0) to (1 1 1)

Arguments, which may be left out: the seconds of a stretch (1), and how often to send a query
before it is given up (6). The bus is that of LCM_DEFAULT_URL, or the usual one of this host. Exit
codes: 0 answered, 1 refused or no service answered, 2 wrong arguments.
--]]

-- What lcm-gen writes is for Lua 5.1, and takes this name when it is loaded.
unpack = unpack or table.unpack

local lcm = require 'lcm'
local pair_query_t = require 'fmb_msgs.pair_query_t'
local pair_result_t = require 'fmb_msgs.pair_result_t'
local placement_t = require 'fmb_msgs.placement_t'

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

-- 53 random bits: what a number of Lua 5.2 holds exactly, and what the service accepts.
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

-- Results go to all clients on the bus. Those of other clients are ignored, as are second results
-- of earlier queries and what cannot be read: no error may leave this for liblcm's own code.
function Client:take(bytes)
    local readable, result = pcall(pair_result_t.decode, bytes)
    if readable and result.client_id == self.id and result.sequence_number == self.number then
        self.result = result
    end
end

function Client:answered()
    return self.result and self.result.status ~= pair_result_t.STATUS_BUSY
end

-- Until there is an answer, or no message came for the time-out. Where other clients' results keep
-- coming, for one to two seconds, as Lua's clock has whole ones. (In Lua, LCM keeps 31 messages and
-- drops the others: beside fast clients, an answer may take some tries.)
function Client:listen()
    local start = os.time()
    while not self:answered() and self.bus:handle_timeout(TIMEOUT_MS) do
        local seconds = os.time() - start
        if seconds < 0 or seconds > 1 then
            break
        end
    end
end

-- LCM loses datagrams without notice, and a busy service has to be queried again later: so the
-- same query is sent again after each time-out, with the same number. On output: the result, or nil
-- where there was none.
function Client:send(query)
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

-- A body is a table with id, shape, numbers (of its only frame: the origin in body coordinates,
-- then the components), position, velocity, and, once the service holds shape and numbers, their
-- handle.
local function placement_of(body)
    local placement = placement_t:new()
    placement.body_id = body.id
    placement.dim = #body.position
    placement.position = body.position
    placement.velocity = body.velocity
    placement.num_velocity = #body.velocity
    if body.handle then
        placement.handle = body.handle
    else
        placement.shapes, placement.num_frames = {body.shape}, 1
        placement.numbers, placement.num_numbers = body.numbers, #body.numbers
    end
    return placement
end

-- A result has the handles of bodies that were sent whole, and zeros for others.
local function keep_handle(body, handle)
    for _, byte in ipairs(handle) do
        if byte ~= 0 then
            body.handle = handle
        end
    end
end

function Client:query_once(a, b, duration)
    local query = pair_query_t:new()
    query.duration = duration
    query.want = pair_query_t.WANT_BOX
    query.a, query.b = placement_of(a), placement_of(b)
    return self:send(query)
end

-- Do two bodies meet within the duration? A service that was started anew, or needed the space,
-- does not hold a body any more: then the bodies are sent whole again. On output: the result, or nil
-- where there was none.
function Client:query_pair(a, b, duration)
    local result = self:query_once(a, b, duration)
    if result and result.status == pair_result_t.STATUS_UNKNOWN_BODY then
        a.handle, b.handle = nil, nil
        result = self:query_once(a, b, duration)
    end
    if result and result.status == pair_result_t.STATUS_OK then
        keep_handle(a, result.handle_a)
        keep_handle(b, result.handle_b)
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
    local numbers = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}
    local cube = {id = 1, shape = placement_t.SHAPE_CUBOID, numbers = numbers, position = {0, 0, 0},
        velocity = {}}
    local tetrahedron = {id = 2, shape = placement_t.SHAPE_TETRAHEDRON, numbers = numbers,
        position = {2, 0, 0}, velocity = {-1.5, 0, 0}}
    for _ = 1, 2 do
        local result = client:query_pair(cube, tetrahedron, duration)
        if not result then
            fail(1, "no fmbd answered on channel %s of %s: start one with 'fmbd &'",
                RESULT_CHANNEL, url)
        end
        if result.status ~= pair_result_t.STATUS_OK then
            fail(1, 'refused with status %d: %s', result.status, result.detail)
        end
        print(result_text(result))
        for axis, speed in ipairs(tetrahedron.velocity) do
            tetrahedron.position[axis] = tetrahedron.position[axis] + duration * speed
        end
    end
end

main()
